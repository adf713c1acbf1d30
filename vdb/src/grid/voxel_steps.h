#pragma once
/// Compares neighboring voxels of a grid: can their values be distances?

#include <openvdb/openvdb.h>

#include <cstdint>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Distances at two voxels never differ by more than the distance between the voxels. If a voxel's
/// value plus the step to its neighbor is less than the band's width, the neighbor must be in the
/// band.
struct VoxelSteps {
  struct Worst {
    double by = 0.0;  ///< [voxels] by how much the difference exceeds the step
    openvdb::Coord at;
  };
  struct Holes {
    std::uint64_t voxels = 0;  ///< voxels of the band beside a missing voxel
    openvdb::Coord at;
  };
  Worst near, far;              ///< beside the surface, and away from it
  Holes near_holes, far_holes;  ///< the same for holes
};

/// [voxels] Voxels up to this distance count as beside the surface. The surface of a cubic spline
/// depends on them; voxels farther off can be rebuilt.
inline constexpr double kBesideSurface = 2.0;

/// [voxels] Contradictions up to this size come from rounding to floats and from other tools.
inline constexpr double kSmallStep = 0.05;

/// Compares each voxel with its 26 neighbors, in parallel; places are the first along the axes.
[[nodiscard]] VoxelSteps stepsOf(const LevelSet& grid);

}  // namespace palpate::vdb
