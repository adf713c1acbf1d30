#pragma once
/// Where a shading looks further than its surface is known, found when a scene is set up.

#include <vector>

#include "palpate/scene/scene.h"

namespace palpate {

/// A layer whose wall is shaded over more than its field knows: a grid has a band only, beyond
/// which it tells a side and no distance. The wall is still shaded, as if all beyond the band were
/// at its rim: less round than was asked for.
struct ShadingGap {
  int material = -1;  ///< index into Scene::materials()
  RegionId region = kOutside;
  Vec3 at{0.0, 0.0, 0.0};  ///< [m] on the surface, where the least is known
  double known = 0.0;      ///< [m] so far from the surface the field answers there
  double needed = 0.0;     ///< [m] so far shading looks
};

/// At most one for each layer. Looks at some fifty places of each surface; for set-up.
[[nodiscard]] std::vector<ShadingGap> shadingGaps(const Scene& scene);

}  // namespace palpate
