#pragma once
/// Finds at set-up where the stiffness of a scene's walls changes within a short distance.

#include <vector>

#include "palpate/scene/scene.h"

namespace palpate {

/// The sharpest contrast of one material.
struct Contrast {
  int material = -1;          ///< index into Scene::materials()
  Vec3 at{0.0, 0.0, 0.0};     ///< [m]
  double length = kInfinity;  ///< [m] over which the stiffness changes by as much as its own value
  /// [-] the largest sideways force there over the force of the wall, at depths from `length` to 32
  /// times that; computed as the `constraint` renderer does, over a patch that grows with the depth
  /// (contact/contact_patch.h)
  double sideways = 0.0;
};

/// One for each material whose stiffness is a map that is not constant. Samples 192 lines through
/// the scene's bounds (or, if it has none, a hundred of its length units around the origin), and
/// halves each step over which the map changes much. A contrast that none of the lines crosses is
/// not found. Takes some milliseconds; for set-up.
[[nodiscard]] std::vector<Contrast> contrastsOf(const Scene& scene);

}  // namespace palpate
