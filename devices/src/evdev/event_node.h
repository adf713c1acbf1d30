#pragma once
// An event node of the kernel, and the queries that it answers.

#include <linux/input.h>

#include <bitset>
#include <optional>
#include <string>

#include "evdev/input_map.h"

namespace palpate::devices::evdev {

/// Owns a file descriptor, which the destructor closes. No call here blocks.
class EventNode {
 public:
  EventNode() = default;
  ~EventNode() { close(); }
  EventNode(const EventNode&) = delete;
  EventNode& operator=(const EventNode&) = delete;

  /// Returns 0, or the errno of the failure.
  [[nodiscard]] int open(const std::string& path) noexcept;
  void close() noexcept;
  [[nodiscard]] bool isOpen() const noexcept { return descriptor_ >= 0; }

  [[nodiscard]] std::string name() const;  ///< empty: it has no name
  /// No value if this is not an event node.
  [[nodiscard]] std::optional<Capabilities> capabilities() const;
  /// Makes its events carry times of the monotonic clock; false if the kernel refuses.
  [[nodiscard]] bool setMonotonic() const noexcept;

  // The functions from here on are real-time safe.
  [[nodiscard]] bool value(std::uint16_t absolute_code, std::int32_t& out) const noexcept;
  [[nodiscard]] bool keys(std::bitset<KEY_CNT>& out) const noexcept;
  /// Like read(): returns the bytes of whole events, or -1 with errno.
  [[nodiscard]] ssize_t read(input_event* out, std::size_t count) const noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace palpate::devices::evdev
