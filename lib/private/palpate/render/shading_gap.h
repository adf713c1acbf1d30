#pragma once
/// Finds at set-up where shading reads a field further from the surface than the field is known.

#include <vector>

#include "palpate/scene/scene.h"

namespace palpate {

/// A layer whose wall is shaded over a larger radius than its field knows: a grid has only a band,
/// beyond which it has a sign and no distance. The wall is still shaded, as if everything beyond
/// the band were at its edge, so it feels less round than was asked for.
struct ShadingGap {
  int material = -1;  ///< index into Scene::materials()
  RegionId region = kOutside;
  Vec3 at{0.0, 0.0, 0.0};  ///< [m] on the surface, where the known distance is smallest
  double known = 0.0;      ///< [m] distance from the surface up to which the field answers there
  double needed = 0.0;     ///< [m] distance from the surface that shading needs
};

/// At most one for each layer. Examines some fifty places of each surface; for set-up.
[[nodiscard]] std::vector<ShadingGap> shadingGaps(const Scene& scene);

}  // namespace palpate
