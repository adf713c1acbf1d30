#pragma once
/// How walls push back and how contents feel. SI throughout.

#include <string>

#include "palpate/core/math.h"

namespace palpate {

/// Friction cone of a wall, as ratios of tangential to normal force.
struct Friction {
  double static_ratio = 0.0;   ///< [-] 0 or more
  double kinetic_ratio = 0.0;  ///< [-] 0 to static_ratio
};

/// One named material of a scene. A wall uses stiffness, damping and friction; a content uses
/// viscosity. A material may serve as both.
struct Material {
  std::string name = {};
  double stiffness = 0.0;  ///< [N/m] 0: cannot be a wall
  double damping = 0.0;    ///< [N s/m] against the probe's velocity while a wall is touched
  Friction friction = {};
  double viscosity = 0.0;    ///< [N s/m] Bv of the drag -Bv V while inside
  Vec3 flow{0.0, 0.0, 0.0};  ///< [m/s] velocity of the medium: drag is -Bv (V - flow)
};

}  // namespace palpate
