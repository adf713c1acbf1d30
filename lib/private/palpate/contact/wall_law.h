#pragma once
/// The force and the stored energy of a wall at one place: those of its spring, pressed by the
/// depth and by a height that is added to the wall's surface.

#include "palpate/contact/wall_spring.h"
#include "palpate/core/math.h"

namespace palpate {

/// The force is secant(d) (d + c). c is the height, limited to `held` times the depth d in both
/// directions; from a depth of `reach` on it fades out, to 0 at twice that depth. So nothing is
/// stored where nothing is pressed, and a light touch is never lost. A value type; real-time safe.
///
/// Height and stiffness may differ from place to place. The energy's derivatives by both, times
/// their gradients, are the force along the wall; without it a way there and back would gain
/// energy.
struct WallLaw {
  WallSpring spring;
  double height = 0.0;       ///< [m] by which the felt surface is above the wall
  double held = 0.5;         ///< [-] limit of the height over the depth; more than 0, less than 1
  double reach = kInfinity;  ///< [m] at least |height| / held

  /// True if the force is the spring's stiffness times the depth.
  [[nodiscard]] bool isStraight() const noexcept { return spring.isStraight() && height == 0.0; }
  /// [N] The force at `depth` [m]; 0 without depth.
  [[nodiscard]] double force(double depth) const noexcept {
    return depth > 0.0 ? spring.secant(depth) * (depth + shown(depth)) : 0.0;
  }
  /// [N/m] The derivative of force() by the depth.
  [[nodiscard]] double tangent(double depth) const noexcept;
  /// [J] The integral of force() over the depth.
  [[nodiscard]] double energy(double depth) const noexcept;
  /// [N] The derivative of the energy by the height (0 where the height is limited), ...
  [[nodiscard]] double energyPerHeight(double depth) const noexcept;
  /// [m^2] ... by the spring's stiffness, ...
  [[nodiscard]] double energyPerStiffness(double depth) const noexcept;
  /// [m^3] ... and by its stiffening.
  [[nodiscard]] double energyPerStiffening(double depth) const noexcept;

  /// [m] The part of the height that counts at `depth` [m].
  [[nodiscard]] double shown(double depth) const noexcept;

 private:
  [[nodiscard]] double fading(double depth) const noexcept;
};

/// The spring that makes up a wall's law when it is in series with a spring of `stop` [N/m]: when
/// it is compressed by `give` [m], the law as a whole is at the depth d with d - force(d) / stop =
/// give. The stop must be stiffer than the law. From the depth on where the law would be stiffer
/// than the stop allows, it continues as a straight line.
struct SoftWall {
  double depth = 0.0;    ///< [m]
  double force = 0.0;    ///< [N]
  double tangent = 0.0;  ///< [N/m] derivative of the force by `give`
};
[[nodiscard]] SoftWall softWall(const WallLaw& law, double stop, double give) noexcept;

}  // namespace palpate
