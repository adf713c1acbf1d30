#pragma once
/// Makes a grid of distances that were found leaf by leaf.

#include "bake/bake_plan.h"
#include "scan/distance_leaves.h"

namespace palpate::vdb {

/// A grid of the leaves' voxels within the band; all other voxels are filled with the sign of their
/// side.
[[nodiscard]] openvdb::FloatGrid::Ptr gridOf(const DistanceLeaves& leaves, const BakePlan& plan,
                                             const BakeOptions& options);

/// Beside creases, distances bend more than a spline through them can follow. There, voxels near
/// the surface are shifted by the spline's error at their closest points, so that the spline passes
/// through the surface there too. Does nothing if the band is too narrow for a cubic spline.
void fitToSpline(const openvdb::FloatGrid::Ptr& grid, const DistanceLeaves& leaves,
                 const BakePlan& plan, const BakeOptions& options);

}  // namespace palpate::vdb
