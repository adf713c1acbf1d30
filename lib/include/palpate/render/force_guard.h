#pragma once
/// The guard between a renderer's force and the motors: it keeps the force finite, clamps, ramps
/// and limits its slew rate.

#include "palpate/export.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate {

/// Applies the limits tick by tick. A value type; real-time safe.
class PALPATE_EXPORT ForceGuard {
 public:
  ForceGuard() = default;  ///< changes only forces that are not finite
  /// Applies `limits` from the first tick on.
  explicit ForceGuard(const ForceLimits& limits) noexcept : limits_(limits) {}

  /// The force [N] that may be sent, `dt` [s] after the last. A force that is not finite becomes
  /// zero; a `dt` that is not finite or below 0 counts as 0.
  ///
  /// First `force` is shortened to max_force, then multiplied by the ramp's share, then held back
  /// by the slew rate: the last force may be scaled down to any share of itself at once (letting go
  /// is never delayed); from there the vector may change by at most max_growth * min(dt, period) in
  /// any direction. So a force that reverses goes to zero at once and grows again from there. The
  /// result is the allowed force nearest to the one asked for. The ramp and the clamp act before
  /// the slew rate, and do not change how fast it lets the force grow.
  [[nodiscard]] Vec3 apply(const Vec3& force, double dt) noexcept;

  /// Back to the state before the first tick: the last force is zero and the ramp begins again.
  void reset() noexcept;

  /// True if the numbers of the last tick are finite, and its time is not below 0; they may be
  /// otherwise after a damaged file was read.
  [[nodiscard]] bool isSound() const noexcept;

 private:
  [[nodiscard]] Vec3 slewed(const Vec3& wanted, double step) const noexcept;

  ForceLimits limits_;
  double age_ = 0.0;          ///< [s] since the first tick; each tick counts as at most one period
  Vec3 last_{0.0, 0.0, 0.0};  ///< [N] the force sent last
};

}  // namespace palpate
