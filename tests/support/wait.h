#pragma once
// Waits for another thread, but with a limit: a test fails instead of hanging.

#include <chrono>
#include <thread>

namespace palpate::testing {

/// A minute from now: far longer than another thread needs on any machine, sanitized or busy.
class Deadline {
 public:
  [[nodiscard]] bool hasPassed() const noexcept { return Clock::now() >= end_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point end_ = Clock::now() + std::chrono::minutes(1);
};

/// Yields until `holds()`; false if the deadline passed before.
template <typename Holds>
[[nodiscard]] bool waitUntil(const Holds& holds) {
  const Deadline deadline;
  while (!holds()) {
    if (deadline.hasPassed()) return false;
    std::this_thread::yield();
  }
  return true;
}

}  // namespace palpate::testing
