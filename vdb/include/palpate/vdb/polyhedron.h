#pragma once
/// Meshes of few flat faces as exact solids: their edges stay sharp.

#include <cstddef>

#include "palpate/fields/field.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// As many flat faces as polyhedronField() takes, unless it is asked otherwise.
inline constexpr std::size_t kMostFlatFaces = 64;

/// The solid between the planes of a mesh's faces, as a tree of unions and intersections of half-spaces, so that
/// contact holds each face, and edges and corners between them, exactly. Triangles that hang together within a
/// millionth of the mesh's size of one plane are one face. Values are bounds of the distance.
///
/// Null, where a grid serves better or nothing else can: more than `most_faces` faces; a mesh that is not closed, with
/// triangles turned alike, as it comes; a part within another and turned against it; parts whose faces no such tree was
/// found for (few: each pocket of the convex hull must have a face on its own hull, and so on inwards). What is given
/// has the mesh's inside at 4000 points, and at both sides of its triangles.
/// @throws Error (kInput) as bakeMesh() does for a mesh without faces, with an index out of range or a vertex that is
/// not finite or far away.
[[nodiscard]] FieldPtr polyhedronField(const Mesh& mesh, std::size_t most_faces = kMostFlatFaces);

}  // namespace palpate::vdb
