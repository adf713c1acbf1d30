#pragma once
/// Where the stiffness of a scene's walls changes within a short way, found when it is set up.

#include <vector>

#include "palpate/scene/scene.h"

namespace palpate {

/// The sharpest contrast of one material.
struct Contrast {
  int material = -1;          ///< index into Scene::materials()
  Vec3 at{0.0, 0.0, 0.0};     ///< [m]
  double length = kInfinity;  ///< [m] over which the stiffness changes by as much as it is
  /// [-] the most that it pushes sideways there, over what the wall pushes back with, at depths
  /// from `length` to 32 times that; felt as the `constraint` renderer does, over a patch that
  /// grows with the depth (contact/contact_patch.h)
  double sideways = 0.0;
};

/// One for each material whose stiffness is a map that changes. Looks along 192 lines through the
/// scene's bounds (a scene without: a hundred of its units about the origin), and halves each step
/// over which the map changes much: a contrast that none of the lines crosses is not seen. Takes
/// some milliseconds; for set-up.
[[nodiscard]] std::vector<Contrast> contrastsOf(const Scene& scene);

}  // namespace palpate
