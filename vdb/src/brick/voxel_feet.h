#pragma once
/// The surface points that follow from a level set's voxels alone.

#include <openvdb/openvdb.h>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// [voxels] Vector from each voxel to its closest point of the surface.
using Offsets = openvdb::Vec3STree;

inline constexpr double kNoFoot = 1e6;  ///< [voxels] no surface point is known

[[nodiscard]] inline openvdb::Vec3f toVdb(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// For each active voxel the surface point found by going against its gradient, as far as its value
/// says. Voxels whose gradient misleads get kNoFoot: those at the rim of the band, whose one-sided
/// differences would be off by a degree, and those beside a crease, whose differences mix values of
/// two sides and come out too small. `offsets` has the leaves of `tree`. The result does not depend
/// on the number of threads.
void findVoxelFeet(const openvdb::FloatTree& tree, double units_per_voxel, Offsets& offsets);

}  // namespace palpate::vdb
