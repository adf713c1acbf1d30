#pragma once
// The servo loop's requests to the operating system: time, sleep, priority, locked memory.

#include <atomic>
#include <cstdint>

namespace palpate::devices {

/// Time of the monotonic clock [ns].
[[nodiscard]] std::int64_t monotonicNs() noexcept;

/// Sleeps until `due` [ns, monotonic], spinning over the last stretch, because a sleeping thread
/// wakes tens of microseconds late. Returns within 10 ms after any thread sets `stop`.
void sleepUntil(std::int64_t due, const std::atomic<bool>& stop) noexcept;

/// Gives the calling thread a real-time priority, locked memory and exact timers while this object
/// exists.
class Elevation {
 public:
  /// `elevate`: try to get priority and memory. `timers`: make the thread's sleeps end on time.
  Elevation(bool elevate, bool timers) noexcept;
  ~Elevation();
  Elevation(const Elevation&) = delete;
  Elevation& operator=(const Elevation&) = delete;

  [[nodiscard]] bool hasPriority() const noexcept { return has_priority_; }
  [[nodiscard]] bool hasLockedMemory() const noexcept { return has_locked_memory_; }
  /// errno of the refusal; 0: granted.
  [[nodiscard]] int priorityError() const noexcept { return priority_error_; }
  [[nodiscard]] int memoryError() const noexcept { return memory_error_; }

 private:
  bool has_priority_ = false;
  bool has_locked_memory_ = false;
  int priority_error_ = 0;
  int memory_error_ = 0;
  int old_policy_ = 0;
  int old_priority_ = 0;
  int old_slack_ = -1;  // [ns]; negative: not changed
};

}  // namespace palpate::devices
