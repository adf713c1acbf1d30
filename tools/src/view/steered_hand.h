#pragma once
/// SteeredHand: a hand that goes where a page says, as a hand goes: smoothly, and no faster than
/// one can follow.

#include <algorithm>
#include <cmath>

#include "palpate/core/math.h"
#include "palpate/devices/seq_lock.h"

namespace palpate::tools {

/// One thread says where to, the servo thread asks where the hand is. Neither waits for the other.
class SteeredHand {
 public:
  static constexpr double kTime = 0.03;     ///< [s] in which it makes 63 % of its way
  static constexpr double kSpeed = 0.5;     ///< [m/s] at most
  static constexpr double kLongest = 0.05;  ///< [s] between two questions that counts as motion

  explicit SteeredHand(const Vec3& start) : place_(start), goal_(start) {}

  /// `goal` [m]; one that is not finite counts as none.
  void steer(const Vec3& goal) noexcept {
    if (isFinite(goal)) asked_.store({goal});
  }

  /// [m] At `t` [s], which does not fall. Real-time safe.
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
