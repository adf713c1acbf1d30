#pragma once
/// Voxels of a grid held against each other: whether they can be distances.

#include <openvdb/openvdb.h>

#include <cstdint>

#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Two distances never differ by more than the way between their voxels, and where a voxel and the
/// way to the next are together shorter than the band is wide, that one is in the band.
struct VoxelSteps {
  struct Worst {
    double by = 0.0;  ///< [voxels] more than the way
    openvdb::Coord at;
  };
  struct Holes {
    std::uint64_t voxels = 0;  ///< of the band, beside a voxel that is missing
    openvdb::Coord at;
  };
  Worst near, far;              ///< beside the surface, and away from it
  Holes near_holes, far_holes;  ///< likewise
};

/// [voxels] Beside the surface is what is no further than that from it. A cubic spline's surface
/// depends on it; what is further can be rebuilt.
inline constexpr double kBesideSurface = 2.0;

/// [voxels] Contradictions up to here are what float voxels and other people's tools leave.
inline constexpr double kSmallStep = 0.05;

/// Looks at each pair of the 26 neighbors, in parallel; places are the first along the axes.
[[nodiscard]] VoxelSteps stepsOf(const LevelSet& grid);

}  // namespace palpate::vdb
