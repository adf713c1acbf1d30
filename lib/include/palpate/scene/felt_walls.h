#pragma once
/// The walls of a scene that a probe can press on.

#include <string>
#include <vector>

#include "palpate/export.h"
#include "palpate/scene/scene.h"

namespace palpate {

/// A wall or a sheet, with the material that gives its feel.
struct FeltWall {
  std::string
      place;  ///< "from | into"; the region alone if no neighbor of it was found; or a sheet
  int material = -1;      ///< index into Scene::materials()
  bool is_sheet = false;  ///< `place` names a sheet
};

/// The walls between regions that were found to touch, if one of the two can be reached; the own
/// walls of layers that have no end and no neighbor in reach (neighbors are searched only near
/// layers that have an end); and all sheets. Allocates.
[[nodiscard]] PALPATE_EXPORT std::vector<FeltWall> feltWalls(const Scene& scene);

}  // namespace palpate
