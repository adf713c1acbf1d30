#pragma once
/// LatencyHistogram: counts how often each duration occurred, in fixed memory.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace palpate::devices {

/// Durations in [ns], resolved to one part in eight. A value type of about 4 kB; add() is real-time
/// safe.
class LatencyHistogram {
 public:
  /// A negative time counts as 0.
  void add(std::int64_t ns) noexcept {
    const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0));
    ++buckets_[bucketOf(value)];
    ++count_;
    longest_ = std::max(longest_, value);
  }

  /// Number of durations added.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// [ns] The longest duration added, exactly; 0 if there are none.
  [[nodiscard]] std::int64_t longest() const noexcept {
    return static_cast<std::int64_t>(longest_);
  }
  /// [ns] The duration that the given share (0 to 1) of the durations does not exceed: at least the
  /// true value, and at most an eighth above it. 0 if there are none.
  [[nodiscard]] std::int64_t quantile(double share) const noexcept {
    const double wanted = std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count_));
    const auto rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(wanted));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      seen += buckets_[i];
      if (seen >= rank) return static_cast<std::int64_t>(std::min(longest_, lastOf(i)));
    }
    return 0;
  }

 private:
  static constexpr std::uint64_t kParts = 8;  // per octave
  static constexpr std::size_t kBuckets = 62 * kParts;

  [[nodiscard]] static std::size_t bucketOf(std::uint64_t value) noexcept {
    if (value < kParts) return value;
    const auto shift = static_cast<std::size_t>(std::bit_width(value)) - 4;
    return (shift + 1) * kParts + ((value >> shift) & (kParts - 1));
  }
  /// The longest duration in a bucket.
  [[nodiscard]] static std::uint64_t lastOf(std::size_t bucket) noexcept {
    if (bucket < kParts) return bucket;
    const std::size_t shift = bucket / kParts - 1;
    return ((kParts + bucket % kParts + 1) << shift) - 1;
  }

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::uint64_t longest_ = 0;
};

}  // namespace palpate::devices
