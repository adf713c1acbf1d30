#pragma once
/// ReadingWatch: the age of the last reading, and the share of a force that may be written because
/// of it.

#include <cstdint>

namespace palpate::devices {

/// Times are in [ns] of one clock. A value type; real-time safe.
class ReadingWatch {
 public:
  ReadingWatch(std::int64_t longest, std::int64_t recovery) noexcept
      : longest_(longest), recovery_(recovery) {}

  /// A turn of the loop at time `now`, with or without a new reading.
  void turn(std::int64_t now, bool is_new) noexcept {
    if (is_new) {
      if (has_expired_ && !is_recovering_) {
        is_recovering_ = true;
        recovered_from_ = now;
      }
      has_expired_ = false;
      last_new_ = now;
    } else if (now - last_new_ >= longest_) {
      has_expired_ = true;
      is_recovering_ = false;
    }
    now_ = now;
    if (is_recovering_ && now_ - recovered_from_ >= recovery_) is_recovering_ = false;
  }

  /// Lets the share begin again at 0, at the time of the last turn.
  void restart() noexcept {
    is_recovering_ = recovery_ > 0;
    recovered_from_ = now_;
  }

  /// True if no new reading came for too long: zero force must be written.
  [[nodiscard]] bool hasExpired() const noexcept { return has_expired_; }
  /// 1; but when readings have come again, or after restart(), it grows from 0 to 1.
  [[nodiscard]] double share() const noexcept {
    if (!is_recovering_) return 1.0;
    return static_cast<double>(now_ - recovered_from_) / static_cast<double>(recovery_);
  }

 private:
  std::int64_t longest_;
  std::int64_t recovery_;
  std::int64_t now_ = 0;
  std::int64_t last_new_ = 0;
  std::int64_t recovered_from_ = 0;
  bool has_expired_ = false;
  bool is_recovering_ = false;
};

}  // namespace palpate::devices
