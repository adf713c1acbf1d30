#pragma once
// An event node that umockdev makes: open(), ioctl() and read() of this process go to it through a
// library that is loaded first. Needs neither special rights nor a kernel module.

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

/// At most one testbed in a process at a time.
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

/// Answers like the kernel's evdev. The calls come from one of umockdev's threads.
class Node {
 public:
  /// /dev/input/event`number` in `bed`.
  Node(const Testbed& bed, int number);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // Capabilities and present state; set them before the node is opened, or while nobody reads it.
  std::string name = "mock";
  std::bitset<KEY_CNT> has_keys, keys;
  std::bitset<REL_CNT> has_relative;
  std::map<int, input_absinfo> absolute;
  bool refuses_clock = false;

  [[nodiscard]] const std::string& path() const { return path_; }
  /// Puts events into the queue, followed by a SYN_REPORT, all with the time `at` [ns, monotonic].
  struct Input {
    int type, code, value;
  };
  void report(std::int64_t at, const std::vector<Input>& inputs);
  /// The same, with the time at which reading `number` (from 0) arrives.
  void reportAtRead(int number, const std::vector<Input>& inputs);
  void unplug();                                      ///< from now on: ENODEV
  void unplugAfter(int calls);                        ///< after that many ioctl() calls: ENODEV
  [[nodiscard]] int clock() const { return clock_; }  ///< the one set by EVIOCSCLOCKID; -1: none

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
