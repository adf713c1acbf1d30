#pragma once
/// What a wall pushes with at one place, and the energy that it stores: its spring, pressed by the
/// depth and by the height at which its surface is felt.

#include "palpate/contact/wall_spring.h"
#include "palpate/core/math.h"

namespace palpate {

/// The force is secant(d) (d + c), with c the height, no more than `held` times the depth d either
/// way, and from a depth of `reach` on fading out over as much again. So nothing is stored where
/// nothing is pressed, and a light touch is never lost. Values; real-time safe.
///
/// Height and stiffness may differ from place to place: the energy's derivatives by both, times
/// their gradients, are the force along the wall without which a way there and back would give
/// energy.
struct WallLaw {
  WallSpring spring;
  double height = 0.0;       ///< [m] at which the surface is felt above the wall
  double held = 0.5;         ///< [-] more than 0, less than 1
  double reach = kInfinity;  ///< [m] at least |height| / held

  /// True if the force is the spring's stiffness times the depth.
  [[nodiscard]] bool isStraight() const noexcept { return spring.isStraight() && height == 0.0; }
  /// [N] that it pushes with, `depth` [m] deep; 0 for no depth.
  [[nodiscard]] double force(double depth) const noexcept {
    return depth > 0.0 ? spring.secant(depth) * (depth + shown(depth)) : 0.0;
  }
  /// [N/m] The derivative of force() by the depth.
  [[nodiscard]] double tangent(double depth) const noexcept;
  /// [J] The integral of force() over the depth.
  [[nodiscard]] double energy(double depth) const noexcept;
  /// [N] Its derivative by the height: 0 where the height is held, ...
  [[nodiscard]] double energyPerHeight(double depth) const noexcept;
  /// [m^2] ... by the spring's stiffness, ...
  [[nodiscard]] double energyPerStiffness(double depth) const noexcept;
  /// [m^3] ... and by its stiffening.
  [[nodiscard]] double energyPerStiffening(double depth) const noexcept;

  /// [m] What of the height counts, `depth` [m] deep.
  [[nodiscard]] double shown(double depth) const noexcept;

 private:
  [[nodiscard]] double fading(double depth) const noexcept;
};

/// A wall's law behind a spring of `stop` [N/m], stiffer than the law is: how deep the law is
/// pressed where the softer of the two gives way by `give` [m], that is d with d - force(d) / stop
/// = give. Where the law would be stiffer than the stop allows, it counts as a straight line from
/// there on.
struct SoftWall {
  double depth = 0.0;    ///< [m]
  double force = 0.0;    ///< [N]
  double tangent = 0.0;  ///< [N/m] of the force by `give`
};
[[nodiscard]] SoftWall softWall(const WallLaw& law, double stop, double give) noexcept;

}  // namespace palpate
