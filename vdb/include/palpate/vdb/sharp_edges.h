#pragma once
/// A mesh's exact triangles by its sharp edges, its grid elsewhere.

#include <cstddef>

#include "palpate/fields/field.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

struct SharpField {
  FieldPtr field;                ///< the baked field itself if there is no sharp edge
  std::size_t edges = 0;         ///< sharp sides of triangles
  std::size_t left_to_grid = 0;  ///< of these; beside them is a wall within the solid, ...
  Vec3 place{0.0};               ///< ... [m] here for one
};

/// `baked`, the field of a grid of `mesh` with voxels of `voxel` [m], but within four voxels of edges that turn by more than
/// `angle` [rad, 0 to pi] the exact signed distance to the triangles; over the fifth voxel the one becomes the other, so
/// that value and gradient have no step. One leaf; contact finds the fold of a hollow edge within it.
///
/// Immutable, and its functions are real-time safe as all fields' are. Costs some 100 bytes for each triangle near a sharp edge
/// and cell of two voxels there.
/// Parts (what hangs together by vertices) that lie within the solid are left out, and parts that are inside out turned, as the
/// grid has them. Where parts pass through each other within five voxels of a sharp edge, so that triangles there are not the
/// solid's surface, that edge is left to the grid.
/// @throws Error (kInput): a mesh that is not closed as it comes (mesh.sharp_open), or one all of whose sharp edges would be left
/// to the grid (mesh.sharp_inner, with a place); what bakeMesh() refuses of a mesh.
[[nodiscard]] SharpField withSharpEdges(FieldPtr baked, const Mesh& mesh, double angle,
                                        double voxel);

}  // namespace palpate::vdb
