#pragma once
/// Vertices that are one.

#include <vector>

#include "bake/edges.h"
#include "bake/solid.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// Vertices in the very same place become one; triangles with two corners in one are dropped.
void weld(const Mesh& mesh, double voxel, Solid& solid);

/// Then those along edges that have not two triangles, where they are nearer than `reach` [voxels],
/// so that closed meshes stay as they are. `sides`: sorted, of the solid's triangles.
/// @returns whether any were joined; triangles then may have become fewer.
bool weldRims(Solid& solid, const std::vector<Side>& sides, double reach);

/// [voxels] From the least of the reaches to try to the largest, while a mesh has open edges: what
/// rounding to floats, or to seven digits of a text, moves a vertex by; and gaps of 1e-5 of the
/// mesh's size and some more. None is more than a tenth of a voxel.
[[nodiscard]] std::vector<double> weldReaches(const Solid& solid);

}  // namespace palpate::vdb
