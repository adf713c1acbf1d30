#pragma once
/// The grid of distances that were found leaf by leaf.

#include "bake/bake_plan.h"
#include "scan/distance_leaves.h"

namespace palpate::vdb {

/// The leaves' voxels within the band, the rest filled by its side.
[[nodiscard]] openvdb::FloatGrid::Ptr gridOf(const DistanceLeaves& leaves, const BakePlan& plan,
                                             const BakeOptions& options);

/// Beside creases, distances bend more than a spline through them can follow. Voxels by the surface
/// move by what that is off where their closest points are, so that it passes through the surface
/// there too. Nothing is done where the band is too narrow for a cubic spline.
void fitToSpline(const openvdb::FloatGrid::Ptr& grid, const DistanceLeaves& leaves,
                 const BakePlan& plan, const BakeOptions& options);

}  // namespace palpate::vdb
