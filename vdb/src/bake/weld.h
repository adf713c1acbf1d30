#pragma once
/// Vertices that are one.

#include <vector>

#include "bake/edges.h"
#include "bake/solid.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// Vertices in the very same place become one; triangles with two corners in one are dropped.
void weld(const Mesh& mesh, double voxel, Solid& solid);

/// Then those along edges that have not two triangles, where they are within a millionth of the mesh's size, so
/// that closed meshes stay as they are. `sides`: sorted, of the solid's triangles.
/// @returns whether any were joined; triangles then may have become fewer.
bool weldRims(Solid& solid, const std::vector<Side>& sides);

}  // namespace palpate::vdb
