#pragma once
/// Explains why no voxel lies inside a mesh.

#include "bake/bake_plan.h"
#include "bake/solid.h"
#include "palpate/core/error.h"

namespace palpate::vdb {

/// `bake.empty` (kInput) with its cause: the mesh is smaller than a voxel, encloses nothing, or is
/// too thin; and with a voxel size that holds it.
[[nodiscard]] Error emptySolidError(const Mesh& mesh, const Solid& solid, const BakePlan& plan);

}  // namespace palpate::vdb
