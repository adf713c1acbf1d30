#include "palpate/scene/felt_walls.h"

#include "palpate/interior/port_machine.h"

namespace palpate {

std::vector<FeltWall> feltWalls(const Scene& scene) {
  std::vector<FeltWall> all;
  const auto regions = scene.regions();
  for (std::size_t j = 0; j < regions.size(); ++j) {
    const auto into = static_cast<RegionId>(j);
    bool is_met = false;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const auto from = static_cast<RegionId>(i);
      if (!regions[i].reachable || !scene.touches(from, into)) continue;
      is_met = true;
      const Wall& wall = scene.passages().wall(from, into);
      if (wall.absent || wall.material < 0) continue;
      all.push_back({regions[i].name + " | " + regions[j].name, wall.material, false});
    }
    const bool has_end = !regions[j].field || regions[j].field->bounds().isBounded();
    if (!is_met && !has_end && regions[j].wall >= 0) {
      all.push_back({regions[j].name, regions[j].wall, false});
    }
  }
  for (const Sheet& sheet : scene.passages().sheets()) {
    if (sheet.material >= 0) all.push_back({sheet.name, sheet.material, true});
  }
  return all;
}

}  // namespace palpate
