#pragma once
/// Triangle meshes and their checks.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/vdb/space.h"

namespace palpate::vdb {

struct Mesh {
  std::string source;          ///< file name, for messages
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::size_t dropped_triangles = 0;  ///< by readMesh(): two corners in one point
  Space space = Space::kRas;          ///< by readMesh(): of the file; vertices are RAS in any case
  bool space_is_stated = false;       ///< by readMesh(): the file said so, as 3D Slicer writes it
};

/// What a look at a mesh showed.
struct MeshReport {
  Box3 bounds;  ///< [m]
  std::size_t degenerate_triangles = 0;
  std::size_t boundary_edges = 0;      ///< with one triangle
  std::size_t non_manifold_edges = 0;  ///< with three or more
  std::size_t flipped_edges = 0;       ///< with two triangles that run along it the same way
  std::size_t components = 0;
  double volume = 0.0;                 ///< [m^3] signed; positive if triangles wind outwards
  Vec3 first_boundary{0.0, 0.0, 0.0};  ///< [m] middle of one boundary edge, if there is any
  [[nodiscard]] bool isClosed() const noexcept { return boundary_edges == 0; }
};

/// Reads STL, OBJ, PLY, legacy VTK polydata, glTF / GLB (and what else Assimp reads, each part where its nodes put it); cuts polygons into
/// triangles; welds vertices in the same place; drops triangles with two corners in one point. Coordinates are LPS
/// if `space` says so, or if it is kStated and the file does (SPACE=LPS); then x and y are negated. Else they are
/// taken as they are.
/// @throws Error (kInput): missing, unreadable, no faces, NaN or infinite vertices, bad indices.
[[nodiscard]] Mesh readMesh(const std::string& path, double metres_per_unit,
                            Space space = Space::kStated);

/// The length unit that a mesh file's format prescribes: "m" for glTF and GLB, by their standard; empty for those that
/// have none, and for what callers know better.
[[nodiscard]] std::string prescribedUnit(const std::string& path);

/// Half-edges counted, components by shared vertices. Every index must be in range.
[[nodiscard]] MeshReport checkMesh(const Mesh& mesh);

}  // namespace palpate::vdb
