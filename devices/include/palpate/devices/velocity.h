#pragma once
/// The hand's velocity out of its positions, by a named estimator whose delay is known.

#include <array>
#include <cstddef>
#include <cstdint>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate::devices {

enum class VelocityEstimator : std::uint8_t {
  /// Over the last interval. Its delay is half of that; an encoder step of q [m] makes it noisy by
  /// q / T.
  kBackwardDifference,
  /// The slope of the least-squares line through the readings of the last `window`. Of readings at
  /// even times its delay is
  /// half the window: it is exact for a motion that accelerates evenly, half a window ago.
  kLeastSquares,
  /// First-order adaptive windowing (Janabi-Sharifi, Hayward and Chen, IEEE Transactions on Control
  /// Systems Technology 8(6), 2000), of each axis by itself: the
  /// slope over a window whose chord no reading in it leaves by more than `noise`. The window grows
  /// reading by reading and stops
  /// before the first chord that some reading leaves, as the paper's does: a longer one may keep
  /// again. Long where the hand is
  /// slow, short where it turns; its delay is half of what it took.
  kAdaptiveWindow,
};

struct VelocitySettings {
  VelocityEstimator estimator = VelocityEstimator::kBackwardDifference;
  double window = 0.01;  ///< [s] kLeastSquares: how far back; kAdaptiveWindow: at most
  /// [m] kAdaptiveWindow: by how much readings of an even motion may leave their chord; 0 or more.
  /// Of an encoder its whole step: each end of the chord is off by up to half of one, and so is
  /// what lies between.
  double noise = 0.0;
};

struct Velocity {
  Vec3 value{0.0, 0.0, 0.0};  ///< [m/s]
  Vec3 delay{0.0, 0.0, 0.0};  ///< [s] it is the velocity so long ago, by axis
};

/// Readings go in, a velocity comes out. A value type; add() never allocates, locks or throws.
class PALPATE_EXPORT VelocityTracker {
 public:
  /// Readings that are kept: a window that holds more of them is that much shorter.
  static constexpr std::size_t kCapacity = 64;
  /// [s] No hand's way is known across a longer gap: the reading behind it is a first one. A time
  /// stamp that leaps ahead by more is broken, and so no velocity comes of it.
  static constexpr double kLongestGap = 10.0;

  /// @throws Error (kUsage, velocity.window, velocity.noise, velocity.estimator) for a window that
  /// is not above 0 or noise that is below 0, or either that is not a number; for an unknown
  /// estimator.
  explicit VelocityTracker(const VelocitySettings& settings = {});

  /// The velocity at the reading at `position` [m] and `time` [s]. Zero at the first. A time that
  /// does not rise repeats the last answer, and the reading is left out; if the time after it rises
  /// again, but not above the last that was taken, the clock was set back, and that reading is a
  /// first one. A position or a time that is not finite gives NaN, and the next one is a first one.
  [[nodiscard]] Velocity add(double time, const Vec3& position) noexcept;
  /// The next reading is a first one.
  void reset() noexcept { count_ = 0; }
  /// Of a value out of a file: what it counts is there.
  [[nodiscard]] bool isSound() const noexcept { return newest_ < kCapacity && count_ <= kCapacity; }

 private:
  struct Reading {
    double time = 0.0;
    Vec3 position{0.0};
  };
  /// The `back`th reading before the newest.
  [[nodiscard]] const Reading& at(std::size_t back) const noexcept {
    return readings_[(newest_ + kCapacity - back) % kCapacity];
  }
  /// How many readings before the newest lie within the window: at least one, if there is one.
  [[nodiscard]] std::size_t reach() const noexcept;
  [[nodiscard]] Velocity leastSquares(std::size_t reach) const noexcept;
  [[nodiscard]] Velocity adaptive(std::size_t reach) const noexcept;
  [[nodiscard]] bool keepsToChord(int axis, std::size_t back) const noexcept;

  VelocitySettings settings_;
  std::array<Reading, kCapacity> readings_{};
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
  double latest_ = 0.0;  ///< [s] the time of the last reading, taken or not
  Velocity last_;
};

}  // namespace palpate::devices
