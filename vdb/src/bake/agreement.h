#pragma once
/// Whether the two ways to tell the inside of a mesh agree.

#include "bake/columns.h"
#include "bake/solid.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// `solid` was made from `mesh` for voxels of `voxel` [m], `columns` from `solid` by kVote.
/// @throws Error (kInput, mesh.ambiguous) naming a place that winding number and flood fill judge
/// differently.
void requireAgreement(const Mesh& mesh, const Solid& solid, const Columns& columns, double voxel);

}  // namespace palpate::vdb
