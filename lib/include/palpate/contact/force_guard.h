#pragma once
/// What stands between a renderer's force and the motors: finite, clamped, ramped, slewed.

#include "palpate/core/math.h"

namespace palpate {

/// A limit that is NaN or below 0 permits nothing: the force is then zero, or cannot grow.
struct ForceLimits {
  double max_force = kInfinity;   ///< [N] longer forces are shortened to it, direction kept
  double max_growth = kInfinity;  ///< [N/s] the slew rate; see ForceGuard::apply()
  double ramp = 0.0;              ///< [s] from zero to full force after the first tick; 0: none
  /// [s] the nominal time from tick to tick. A longer one (a gap, a late tick) counts as this, so
  /// that what one tick may bring is max_growth * period at most, whatever the clock says.
  double period = 1e-3;
};

/// Applies the limits tick by tick. A value; real-time safe.
class ForceGuard {
 public:
  ForceGuard() = default;
  explicit ForceGuard(const ForceLimits& limits) noexcept : limits_(limits) {}

  /// The force [N] that may be sent, `dt` [s] after the last. A force that is not finite becomes
  /// zero; a `dt` that is not finite or below 0 counts as 0.
  ///
  /// First `force` is shortened to max_force, then multiplied by the ramp's share, then held back
  /// by the slew rate: the last force may shrink to any share of itself at once (letting go is
  /// never delayed), and beyond that the vector moves by no more than max_growth * min(dt, period),
  /// whatever its direction. So a force that turns round goes to zero at once and grows again from
  /// there. Of all forces allowed it is the nearest. The ramp and the clamp act before the slew
  /// rate, and do not change how fast it lets the force grow.
  [[nodiscard]] Vec3 apply(const Vec3& force, double dt) noexcept;

  /// As before the first tick: the last force is zero and the ramp begins again.
  void reset() noexcept;

 private:
  [[nodiscard]] Vec3 slewed(const Vec3& wanted, double step) const noexcept;

  ForceLimits limits_;
  double age_ = 0.0;          ///< [s] since the first tick, each tick counted as a period at most
  Vec3 last_{0.0, 0.0, 0.0};  ///< [N] sent last
};

}  // namespace palpate
