#pragma once
/// Durations of ticks: order statistics of any number of them in constant memory.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate::tools {

/// Counts times by value: exact up to 65 us, and to one part in 256 beyond.
class TickTimes {
 public:
  TickTimes() : counts_(kExact + kSteps * (64 - kExactBits)) {}

  void add(std::int64_t ns) noexcept {
    const auto time = static_cast<std::uint64_t>(std::max<std::int64_t>(0, ns));
    ++counts_[placeOf(time)];
    ++count_;
    longest_ = std::max(longest_, time);
  }

  /// [ns] The smallest time t such that at least the share `share` of all times are at most t; 0 if
  /// there are none.
  [[nodiscard]] double quantile(double share) const noexcept {
    if (count_ == 0) return 0.0;
    const auto rank = std::clamp<std::uint64_t>(
        static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_))), 1, count_);
    std::uint64_t seen = 0;
    std::size_t place = 0;
    while ((seen += counts_[place]) < rank) ++place;
    return static_cast<double>(std::min(longestAt(place), longest_));
  }
  [[nodiscard]] double longest() const noexcept { return static_cast<double>(longest_); }  ///< [ns]

 private:
  static constexpr unsigned kExactBits = 16;
  static constexpr unsigned kStepBits = 8;
  static constexpr std::size_t kExact = std::size_t{1} << kExactBits;
  static constexpr std::size_t kSteps = std::size_t{1} << kStepBits;

  [[nodiscard]] static std::size_t placeOf(std::uint64_t time) noexcept {
    if (time < kExact) return static_cast<std::size_t>(time);
    const auto octave = static_cast<unsigned>(std::bit_width(time)) - 1;  // 16 and more
    const std::uint64_t step = (time >> (octave - kStepBits)) - kSteps;
    return kExact + kSteps * (octave - kExactBits) + static_cast<std::size_t>(step);
  }
  /// [ns] The longest time that is counted at that place.
  [[nodiscard]] static std::uint64_t longestAt(std::size_t place) noexcept {
    if (place < kExact) return place;
    const std::size_t above = place - kExact;
    const unsigned octave = kExactBits + static_cast<unsigned>(above / kSteps);
    const std::uint64_t step = kSteps + above % kSteps;
    return ((step + 1) << (octave - kStepBits)) - 1;
  }

  std::vector<std::uint64_t> counts_;
  std::uint64_t count_ = 0;
  std::uint64_t longest_ = 0;
};

}  // namespace palpate::tools
