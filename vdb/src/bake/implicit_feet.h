#pragma once
/// Where the surface of an implicit field is, as a bake needs it: voxels beside it with their
/// closest points.

#include <openvdb/openvdb.h>

#include <vector>

#include "bake/bake_plan.h"
#include "scan/distance_leaves.h"

namespace palpate::vdb {

/// A voxel by the surface, and the way from there to its closest point [voxels].
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
      leaves;  ///< a voxel that is in none, or not known there, has its neighbors' side
};

/// Looks at what lies within `domain` [m]: cubes of voxels are halved and dropped where the field's
/// Lipschitz bound says that the surface is not there. Of a plate that passes between voxels there
/// are feet too.
/// @throws Error (kOperation) for memory, (kInput) where the field is not a number, kCancelled.
[[nodiscard]] ImplicitSurface findSurface(const Field& field, const Box3& domain,
                                          const BakePlan& plan, const BakeOptions& options,
                                          const Progress& progress);

}  // namespace palpate::vdb
