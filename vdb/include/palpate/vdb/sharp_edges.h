#pragma once
/// A mesh's exact triangles by its sharp edges, its grid elsewhere.

#include "palpate/fields/field.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// `baked`, the field of a grid of `mesh` with voxels of `voxel` [m], but within four voxels of edges that turn by more than
/// `angle` [rad, 0 to pi] the exact signed distance to the triangles; over the fifth voxel the one becomes the other, so
/// that value and gradient have no step. One leaf; contact finds the fold of a hollow edge within it. `baked`
/// itself if there is no such edge.
///
/// Immutable, and its functions are real-time safe as all fields' are. Costs some 100 bytes for each triangle near a sharp edge
/// and cell of two voxels there.
/// Parts (what hangs together by vertices) that lie within the solid are left out, and parts that are inside out turned, as the
/// grid has them.
/// @throws Error (kInput): a mesh that is not closed as it comes (mesh.sharp_open), or whose triangles within five voxels of
/// such edges are not the grid's surface (mesh.sharp_inner, with a place: parts pass through each other there); what
/// bakeMesh() refuses of a mesh.
[[nodiscard]] FieldPtr withSharpEdges(FieldPtr baked, const Mesh& mesh, double angle, double voxel);

}  // namespace palpate::vdb
