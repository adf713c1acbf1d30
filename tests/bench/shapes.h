#pragma once
/// The data to sample: grids, and a path along the surface of each.

#include <string>
#include <vector>

#include "palpate/vdb/level_set.h"

namespace palpate::bench {

struct Shape {
  std::string name;
  vdb::LevelSet grid;
  std::vector<Vec3> path;  ///< [m] 0.2 mm or less apart, rising and falling through half a voxel
};

/// Torus 35/15 mm with voxels of 1 mm, rotated and shifted against the grid.
[[nodiscard]] Shape torusShape();
/// Ball of 50 mm with voxels of 0.5 mm.
[[nodiscard]] Shape ballShape();
/// A closed mesh in mm, with voxels of a 128th of its longest side. @throws Error.
[[nodiscard]] Shape meshShape(const std::string& file);

}  // namespace palpate::bench
