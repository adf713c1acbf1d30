#pragma once
/// A level set as a triangle mesh, and meshes as files.

#include <string>

#include "palpate/core/progress.h"
#include "palpate/vdb/level_set.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// The zero set of a level set: one vertex in each cell that it passes through (dual marching cubes,
/// OpenVDB's volumeToMesh), moved onto the zero set of gridField(grid). Closed where the level set is;
/// triangles wind outwards. Vertices stray from the field by at most a thousandth of a voxel, the
/// triangles between them by about voxel^2 / 8 of the curvature.
/// @throws Error: kInput if the grid has no surface, kCancelled.
[[nodiscard]] Mesh surfaceMesh(const LevelSet& grid, const Progress& progress = {});

enum class MeshFormat {
  kStl,  ///< binary; a float for each coordinate, no unit
  kObj,  ///< text that reads back exactly, no unit
  kPly,  ///< binary little endian, doubles, no unit
  kGlb,  ///< binary glTF 2.0; floats, always in metres, axes as they are
};

/// By the file's extension, in any case. @throws Error (kInput) for any other.
[[nodiscard]] MeshFormat meshFormat(const std::string& path);

/// The file's bytes. One unit of it is `metres_per_unit`; kGlb is in metres, whatever that says.
/// @throws Error (kInput) for a mesh without triangles, or too large for the format (2^32 bytes).
[[nodiscard]] std::string encodeMesh(const Mesh& mesh, MeshFormat format, double metres_per_unit);

}  // namespace palpate::vdb
