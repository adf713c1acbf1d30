#pragma once
/// SteeredHand: a hand that moves to where a page wants it, as a real hand would: smoothly, and not
/// too fast to follow.

#include <algorithm>
#include <cmath>

#include "palpate/core/math.h"
#include "palpate/devices/seq_lock.h"

namespace palpate::tools {

/// One thread sets the goal, and the servo thread asks for the hand's position. Neither waits for
/// the other.
class SteeredHand {
 public:
  /// [s] time constant: it covers 63 % of the distance in this time
  static constexpr double kTime = 0.03;
  static constexpr double kSpeed = 0.5;  ///< [m/s] at most
  /// [s] longest time between two calls of at() that counts as motion
  static constexpr double kLongest = 0.05;

  explicit SteeredHand(const Vec3& start) : place_(start), goal_(start) {}

  /// `goal` [m]; a goal that is not finite is ignored.
  void steer(const Vec3& goal) noexcept {
    if (isFinite(goal)) asked_.store({goal});
  }

  /// [m] Position at `t` [s]; t must not decrease. Real-time safe.
  [[nodiscard]] Vec3 at(double t) noexcept {
    if (const auto asked = asked_.load()) goal_ = asked->goal;
    const double dt = std::clamp(t - last_, 0.0, kLongest);
    last_ = t;
    Vec3 step = (1.0 - std::exp(-dt / kTime)) * (goal_ - place_);
    const double length = glm::length(step);
    if (length > kSpeed * dt) step *= kSpeed * dt / length;
    place_ += step;
    return place_;
  }

 private:
  struct Asked {
    Vec3 goal{0.0, 0.0, 0.0};
  };
  devices::SeqLock<Asked> asked_;
  Vec3 place_;  ///< [m]
  Vec3 goal_;   ///< [m]
  double last_ = 0.0;
};

}  // namespace palpate::tools
