#pragma once
/// The walls of a scene that a probe can press on.

#include <string>
#include <vector>

#include "palpate/export.h"
#include "palpate/scene/scene.h"

namespace palpate {

/// A wall or a sheet, with the material that it is felt with.
struct FeltWall {
  std::string
      place;  ///< "from | into"; the region alone where none was found beside it; or a sheet
  int material = -1;  ///< index into Scene::materials()
  bool is_sheet = false;
};

/// Those between regions that were found to touch, from a region that can be reached; the own walls
/// of layers without end of which none was found to be in reach, since what touches what was looked
/// for near the layers that have an end; and all sheets. Allocates.
[[nodiscard]] PALPATE_EXPORT std::vector<FeltWall> feltWalls(const Scene& scene);

}  // namespace palpate
