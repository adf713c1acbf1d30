#pragma once
/// The distance to the surface of a field whose value is not a distance.

#include "bake/bake_plan.h"

namespace palpate::vdb {

/// Where to bake.
struct BakeDomain {
  Box3 box;             ///< [m] bounded
  bool is_cut = false;  ///< the shape reaches out of it, and is cut off by its faces
};

/// The zero set of `field` as a grid: each voxel of the band has the distance to its closest point,
/// by Newton's method. Voxels by the surface search from where they are, the others from the
/// closest points of their neighbors, layer by layer; at last each looks whether a neighbor's is
/// nearer. Where the method leads nowhere (an edge, a cusp, a place where the gradient vanishes),
/// the distance is to a point of the surface that was found by creeping along it, or to a
/// neighbor's, so that no voxel ever says more than what is free around it plus a voxel.
///
/// What the faces of the box cut off is as with an intersection: the larger of distance and wall.
/// Does not depend on the number of threads. @throws Error as bake().
[[nodiscard]] openvdb::FloatGrid::Ptr implicitDistances(const Field& field,
                                                        const BakeDomain& domain,
                                                        const BakePlan& plan,
                                                        const BakeOptions& options,
                                                        const Progress& progress);

}  // namespace palpate::vdb
