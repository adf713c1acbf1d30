#pragma once
/// What stands between a renderer's force and the motors: finite, clamped, slewed, ramped.

#include "palpate/core/math.h"

namespace palpate {

struct ForceLimits {
  double max_force = kInfinity;   ///< [N] longer forces are shortened to it, direction kept
  double max_growth = kInfinity;  ///< [N/s] the magnitude grows no faster; it may drop at once
  double ramp = 0.0;              ///< [s] from zero to full force after the first tick; 0: none
};

/// Applies the limits tick by tick. A value; real-time safe.
class ForceGuard {
 public:
  ForceGuard() = default;
  explicit ForceGuard(const ForceLimits& limits) noexcept : limits_(limits) {}

  /// The force [N] that may be sent, `dt` [s] after the last. A force that is not finite becomes zero.
  /// The slew limit holds back growth only: letting go is never delayed. After zero (a fault, a
  /// gap, free space) growth starts from zero again.
  [[nodiscard]] Vec3 apply(const Vec3& force, double dt) noexcept;

  /// As before the first tick: the ramp begins again.
  void reset() noexcept;

 private:
  ForceLimits limits_;
  double age_ = 0.0;        ///< [s] since the first tick
  double magnitude_ = 0.0;  ///< [N] sent last
};

}  // namespace palpate
