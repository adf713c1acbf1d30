#pragma once
/// A mesh prepared for baking: checked, welded, turned alike, its holes closed.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "palpate/vdb/bake.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// Triangles connected by shared vertices.
struct SolidPart {
  double volume = 0.0;        ///< [voxels^3] signed
  double area = 0.0;          ///< [voxels^2]
  double minority = 0.0;      ///< share of the area that was turned to agree with the rest
  Vec3 place{0.0, 0.0, 0.0};  ///< [voxels] a vertex
  Box3 box;                   ///< [voxels]
};

/// Along every edge as many triangles run one way as the other, so that the winding number is an
/// integer and does not depend on the ray along which it is counted.
struct Solid {
  std::vector<Vec3> vertices;  ///< [voxels]
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> part_of;  ///< for each triangle
  std::vector<SolidPart> parts;
  bool was_closed = true;  ///< as it was read: two triangles on each edge, turned alike
  std::string dropped;     ///< "3 open fragments, ..."; empty if there were none
};

/// Drops open parts that are too small for the voxels to hold, unless `sign` says what closes them.
/// @throws Error (kInput), each with a place: no faces, index out of range, vertex not finite or
/// far from all others, or holes so large that the shape does not tell where the wall was
/// (mesh.open; only if `sign` is kVote).
[[nodiscard]] Solid makeSolid(const Mesh& mesh, double voxel, MeshSign sign);

/// The mesh, only checked, welded and without doubled triangles: for a shell about the surface.
[[nodiscard]] Solid makeSurface(const Mesh& mesh, double voxel);

}  // namespace palpate::vdb
