#pragma once
// The times at which the ticks of a real-time loop are due.

#include <algorithm>
#include <cstdint>

namespace palpate::devices {

/// Tick k is due at start + k * period. Ticks missed by an overrun are left out: a burst of ticks
/// to catch up would be felt as a kick. Times are in [ns] of one clock.
class ServoSchedule {
 public:
  ServoSchedule(std::int64_t start, std::int64_t period) noexcept : due_(start), period_(period) {}

  [[nodiscard]] std::int64_t due() const noexcept { return due_; }
  [[nodiscard]] std::int64_t worstLateness() const noexcept { return worst_lateness_; }
  [[nodiscard]] std::uint64_t overruns() const noexcept { return overruns_; }

  /// The tick that was due begins at `now`.
  void begin(std::int64_t now) noexcept { worst_lateness_ = std::max(worst_lateness_, now - due_); }

  /// The tick ends at `now`; from then on due() is that of the next tick.
  void end(std::int64_t now) noexcept {
    due_ += period_;
    if (now <= due_) return;
    ++overruns_;
    due_ += ((now - due_ - 1) / period_ + 1) * period_;
  }

 private:
  std::int64_t due_;
  std::int64_t period_;
  std::int64_t worst_lateness_ = 0;
  std::uint64_t overruns_ = 0;
};

}  // namespace palpate::devices
