#pragma once
/// Estimates the hand's velocity from its positions, by a named estimator whose delay is known.

#include <array>
#include <cstddef>
#include <cstdint>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate::devices {

/// How a velocity follows from the last readings; T is the time from reading to reading.
enum class VelocityEstimator : std::uint8_t {
  /// The mean over the last interval. Its delay is half of that; an encoder step of q [m] adds
  /// noise of q / T.
  kBackwardDifference,
  /// The slope of the least-squares line through the readings of the last `window`. For equally
  /// spaced readings its delay is half the window: for a motion with constant acceleration it is
  /// exactly the velocity half a window ago.
  kLeastSquares,
  /// First-order adaptive windowing (Janabi-Sharifi, Hayward and Chen, IEEE Transactions on Control
  /// Systems Technology 8(6), 2000), for each axis separately: the slope over a window in which no
  /// reading is farther than `noise` from the window's chord. As in the paper, the window grows
  /// reading by reading and stops before the first chord from which some reading is farther,
  /// although an even longer window might be valid again. The window is long where the hand is
  /// slow, and short where it turns; the delay is half of the window.
  kAdaptiveWindow,
};

/// The settings of VelocityTracker.
struct VelocitySettings {
  VelocityEstimator estimator =
      VelocityEstimator::kBackwardDifference;  ///< how velocities are computed
  double window = 0.01;  ///< [s] length of the window; for kAdaptiveWindow its largest length
  /// [m] kAdaptiveWindow: largest distance of readings of a uniform motion from their chord; 0 or
  /// more. For an encoder it is a whole step: each end of the chord is wrong by up to half a step,
  /// and so are the readings in between.
  double noise = 0.0;
};

/// An estimate and its delay.
struct Velocity {
  Vec3 value{0.0, 0.0, 0.0};  ///< [m/s]
  Vec3 delay{0.0, 0.0, 0.0};  ///< [s] by axis: it is the velocity at this time before the reading
};

/// Turns readings into a velocity. A value type; add() never allocates, locks or throws.
class PALPATE_EXPORT VelocityTracker {
 public:
  /// The most readings that are kept: a window that would contain more of them is shortened.
  static constexpr std::size_t kCapacity = 64;
  /// [s] The hand's motion during a longer gap is not known, so the reading after it counts as a
  /// first one. A time stamp that leaps ahead by more than this is broken, and this also prevents a
  /// velocity from being computed from it.
  static constexpr double kLongestGap = 10.0;

  /// @throws Error (kUsage, velocity.window, velocity.noise, velocity.estimator) for a window that
  /// is not above 0 or noise that is below 0, or either that is not a number; for an unknown
  /// estimator.
  explicit VelocityTracker(const VelocitySettings& settings = {});

  /// The velocity at the reading at `position` [m] and `time` [s]; zero at the first. If the time
  /// does not increase, the last result is repeated and the reading is ignored. If the time of the
  /// next reading increases again, but not above that of the last reading used, the clock was set
  /// back, and that reading counts as a first one. A position or a time that is not finite gives
  /// NaN, and the next reading counts as a first one.
  [[nodiscard]] Velocity add(double time, const Vec3& position) noexcept;
  /// Makes the next reading a first one.
  void reset() noexcept { count_ = 0; }
  /// For a value read from a file: whether its counts are within its arrays.
  [[nodiscard]] bool isSound() const noexcept { return newest_ < kCapacity && count_ <= kCapacity; }

 private:
  struct Reading {
    double time = 0.0;
    Vec3 position{0.0};
  };
  /// The reading `back` places before the newest.
  [[nodiscard]] const Reading& at(std::size_t back) const noexcept {
    return readings_[(newest_ + kCapacity - back) % kCapacity];
  }
  /// Number of readings before the newest that lie within the window: at least one, if there is
  /// one.
  [[nodiscard]] std::size_t reach() const noexcept;
  [[nodiscard]] Velocity leastSquares(std::size_t reach) const noexcept;
  [[nodiscard]] Velocity adaptive(std::size_t reach) const noexcept;
  [[nodiscard]] bool keepsToChord(int axis, std::size_t back) const noexcept;

  VelocitySettings settings_;
  std::array<Reading, kCapacity> readings_{};
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  double latest_ = 0.0;  ///< [s] the time of the last reading, used or not
  Velocity last_;
};

}  // namespace palpate::devices
