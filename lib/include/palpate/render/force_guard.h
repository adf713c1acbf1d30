#pragma once
/// What stands between a renderer's force and the motors: finite, clamped, ramped, slewed.

#include "palpate/export.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate {

/// Applies the limits tick by tick. A value; real-time safe.
class PALPATE_EXPORT ForceGuard {
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

  /// True if the numbers of the last tick are finite, and its time is not below 0; a damaged file
  /// may say otherwise.
  [[nodiscard]] bool isSound() const noexcept;

 private:
  [[nodiscard]] Vec3 slewed(const Vec3& wanted, double step) const noexcept;

  ForceLimits limits_;
  double age_ = 0.0;          ///< [s] since the first tick, each tick counted as a period at most
  Vec3 last_{0.0, 0.0, 0.0};  ///< [N] sent last
};

}  // namespace palpate
