#pragma once
/// Distances to the surface of a field whose value is not a distance.

#include "bake/bake_plan.h"

namespace palpate::vdb {

/// Where to bake.
struct BakeDomain {
  Box3 box;             ///< [m] bounded
  bool is_cut = false;  ///< the shape reaches beyond the box, and is cut off by its faces
};

/// The zero set of `field` as a grid: each voxel of the band gets the distance to its closest
/// point, by Newton's method. Voxels next to the surface start from their own place, the others
/// from the closest points of their neighbors, layer by layer; at the end each voxel checks whether
/// a neighbor's point is nearer. Where the method fails (an edge, a cusp, a place where the
/// gradient vanishes), the distance is that to a point found by small steps along the surface, or
/// to a neighbor's point, so that no voxel ever overestimates the free space around it by more than
/// a voxel.
///
/// Where the faces of the box cut the shape off, the value is that of an intersection: the larger
/// of surface distance and wall distance. The result does not depend on the number of threads.
/// @throws Error as bake().
[[nodiscard]] openvdb::FloatGrid::Ptr implicitDistances(const Field& field,
                                                        const BakeDomain& domain,
                                                        const BakePlan& plan,
                                                        const BakeOptions& options,
                                                        const Progress& progress);

}  // namespace palpate::vdb
