#pragma once
/// Where the surface of an implicit field is, in the form that a bake needs: voxels beside it with
/// their closest points.

#include <openvdb/openvdb.h>

#include <vector>

#include "bake/bake_plan.h"
#include "scan/distance_leaves.h"

namespace palpate::vdb {

/// A voxel beside the surface, and the vector from it to its closest point [voxels].
struct SurfaceFoot {
  openvdb::Coord voxel;
  Vec3 foot;
};

/// Voxels of a leaf whose side is known from the field's value there.
struct KnownSides {
  openvdb::Coord origin;
  VoxelBits known{};
  VoxelBits inside{};
};

struct ImplicitSurface {
  std::vector<SurfaceFoot> feet;  ///< in a fixed order
  std::vector<KnownSides>
      leaves;  ///< a voxel that is in no leaf, or not known in its leaf, has its neighbors' side
};

/// Searches `domain` [m]: cubes of voxels are halved, and dropped where the field's Lipschitz bound
/// excludes the surface. A plate that passes between voxels has feet too.
/// @throws Error (kOperation) for memory, (kInput) where the field is not a number, kCancelled.
[[nodiscard]] ImplicitSurface findSurface(const Field& field, const Box3& domain,
                                          const BakePlan& plan, const BakeOptions& options,
                                          const Progress& progress);

}  // namespace palpate::vdb
