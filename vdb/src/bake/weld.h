#pragma once
/// Joins vertices that are at one place.

#include <vector>

#include "bake/edges.h"
#include "bake/solid.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// Vertices at exactly the same place become one; triangles with two corners at one place are
/// dropped.
void weld(const Mesh& mesh, double voxel, Solid& solid);

/// Then joins vertices that are nearer than `reach` [voxels], but only along edges that do not have
/// two triangles, so that closed meshes stay as they are. `sides`: sorted, of the solid's
/// triangles.
/// @returns whether any were joined; triangles then may have become fewer.
bool weldRims(Solid& solid, const std::vector<Side>& sides, double reach);

/// [voxels] The reaches to try, from the smallest to the largest, while a mesh has open edges. They
/// cover the rounding of a vertex to floats, or to seven digits of a text, and gaps of a little
/// more than 1e-5 of the mesh's size. None is more than a tenth of a voxel.
[[nodiscard]] std::vector<double> weldReaches(const Solid& solid);

}  // namespace palpate::vdb
