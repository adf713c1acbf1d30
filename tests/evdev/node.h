#pragma once
// An event node that umockdev makes: open(), ioctl() and read() of this process go to it, by its
// library that is loaded first. Needs no right and no kernel module.

#include <linux/input.h>
#include <umockdev.h>

#include <bitset>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace palpate::testing {

/// One testbed a process at a time.
class Testbed {
 public:
  Testbed() : bed_(umockdev_testbed_new()) {}
  ~Testbed() { g_object_unref(bed_); }
  Testbed(const Testbed&) = delete;
  Testbed& operator=(const Testbed&) = delete;
  [[nodiscard]] UMockdevTestbed* get() const { return bed_; }

 private:
  UMockdevTestbed* bed_;
};

/// Answers as the kernel's evdev does. The calls come from a thread of umockdev's.
class Node {
 public:
  /// /dev/input/event`number` in `bed`.
  Node(const Testbed& bed, int number);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // What it has and is at; set before it is opened, or while nobody asks.
  std::string name = "mock";
  std::bitset<KEY_CNT> has_keys, keys;
  std::bitset<REL_CNT> has_relative;
  std::map<int, input_absinfo> absolute;
  bool refuses_clock = false;

  [[nodiscard]] const std::string& path() const { return path_; }
  /// Puts events into the queue, with a SYN_REPORT after them, all of the time `at` [ns,
  /// monotonic].
  struct Input {
    int type, code, value;
  };
  void report(std::int64_t at, const std::vector<Input>& inputs);
  /// The same, of the time when the reading `number` (from 0) comes.
  void reportAtRead(int number, const std::vector<Input>& inputs);
  void unplug();                                      ///< from now on: ENODEV
  void unplugAfter(int calls);                        ///< of ioctl(): ENODEV from then on
  [[nodiscard]] int clock() const { return clock_; }  ///< that EVIOCSCLOCKID has set; -1: none

 private:
  static gboolean onIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  static gboolean onRead(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  void push(std::int64_t at, const std::vector<Input>& inputs);
  [[nodiscard]] bool answer(UMockdevIoctlClient* client);
  [[nodiscard]] std::vector<unsigned char> bytesFor(unsigned number);

  const Testbed& bed_;
  std::string path_;
  UMockdevIoctlBase* base_;
  std::mutex mutex_;
  std::deque<input_event> queue_;
  std::map<int, std::vector<Input>> at_read_;
  int reads_ = 0;
  bool is_gone_ = false;
  int calls_left_ = -1;  // below 0: no limit
  int clock_ = -1;
};

}  // namespace palpate::testing
