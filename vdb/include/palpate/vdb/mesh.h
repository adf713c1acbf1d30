#pragma once
/// Triangle meshes: read, checked, felt with their edges sharp, made of level sets, and written.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/core/progress.h"
#include "palpate/export.h"
#include "palpate/fields/field.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Triangles that share vertices; not necessarily closed or sound (see checkMesh()).
struct Mesh {
  std::string source;          ///< file name, for messages
  std::vector<Vec3> vertices;  ///< [m]
  /// Indices into `vertices`; counterclockwise as seen from outside if they wind outwards.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::size_t dropped_triangles = 0;  ///< by readMesh(), for two corners in one point
  Space space = Space::kRas;  ///< set by readMesh(): the file's space; vertices are RAS in any case
  /// Set by readMesh(): the file stated its space, as 3D Slicer writes it
  bool space_is_stated = false;
};

/// The result of checking a mesh.
struct MeshReport {
  Box3 bounds;                           ///< [m]
  std::size_t degenerate_triangles = 0;  ///< without an area
  std::size_t boundary_edges = 0;        ///< with one triangle
  std::size_t non_manifold_edges = 0;    ///< with three or more
  std::size_t flipped_edges = 0;         ///< with two triangles that run along it the same way
  std::size_t components = 0;            ///< pieces whose triangles hang together by vertices
  double volume = 0.0;                   ///< [m^3] signed; positive if triangles wind outwards
  Vec3 first_boundary{0.0, 0.0, 0.0};    ///< [m] middle of one boundary edge, if there is any
  /// True if every edge has at least two triangles, whichever way these wind.
  [[nodiscard]] bool isClosed() const noexcept { return boundary_edges == 0; }
};

/// Reads STL, OBJ, PLY, legacy VTK polydata, glTF / GLB (and the other formats that Assimp reads,
/// each part where its nodes put it); cuts polygons into triangles; welds vertices in the same
/// place; drops triangles with two corners in one point. Coordinates are LPS if `space` says so, or
/// if it is kStated and the file does (SPACE=LPS); then x and y are negated. Otherwise they are
/// taken as they are.
/// @throws Error (kInput): missing, unreadable, no faces, NaN or infinite vertices, bad indices.
[[nodiscard]] PALPATE_EXPORT Mesh readMesh(const std::string& path, double meters_per_unit,
                                           Space space = Space::kStated);

/// The length unit that a mesh file's format prescribes: "m" for glTF and GLB, by their standard;
/// empty for formats that prescribe none, whose unit callers have to know.
[[nodiscard]] PALPATE_EXPORT std::string prescribedUnit(const std::string& path);

/// Half-edges counted, components by shared vertices. Every index must be in range.
[[nodiscard]] PALPATE_EXPORT MeshReport checkMesh(const Mesh& mesh);

/// The zero set of a level set: one vertex in each cell that it passes through (dual marching
/// cubes, OpenVDB's volumeToMesh), moved onto the zero set of gridField(grid). The mesh is closed
/// where the level set is; triangles wind outwards. Vertices stray from the field by at most a
/// thousandth of a voxel, the triangles between them by about voxel^2 / 8 of the curvature.
/// @throws Error: kInput if the grid has no surface, kCancelled.
[[nodiscard]] PALPATE_EXPORT Mesh surfaceMesh(const LevelSet& grid, const Progress& progress = {});

/// A format in which meshes are written.
enum class MeshFormat {
  kStl,  ///< binary; a float for each coordinate, no unit
  kObj,  ///< text that reads back exactly, no unit
  kPly,  ///< binary little endian, doubles, no unit
  kGlb,  ///< binary glTF 2.0; floats, always in meters, axes as they are
};

/// The format that the extension names, in any case. @throws Error (kInput) if it names none.
[[nodiscard]] PALPATE_EXPORT MeshFormat meshFormat(const std::string& path);

/// The file's bytes, in units of `meters_per_unit`; kGlb is in meters, whatever that says.
/// @throws Error (kInput) for a mesh without triangles, or too large for the format (2^32 bytes).
[[nodiscard]] PALPATE_EXPORT std::string encodeMesh(const Mesh& mesh, MeshFormat format,
                                                    double meters_per_unit);

/// The most flat faces that polyhedronField() takes unless the caller says otherwise.
inline constexpr std::size_t kMostFlatFaces = 64;

/// The solid between the planes of a mesh's faces, as a tree of unions and intersections of
/// half-spaces, so that contact holds each face, and edges and corners between them, exactly.
/// Connected triangles that lie within a millionth of the mesh's size of one plane are one face.
/// Values are bounds of the distance.
///
/// Null, where a grid serves better or is the only way: for more than `most_faces` faces; for a
/// mesh that is not closed, or whose triangles are not turned alike, as it was read; for a part
/// within another and turned against it; for parts for whose faces no such tree was found (rare:
/// each pocket of the convex hull must have a face on its own hull, and so on inwards). A field
/// that is returned agrees with the mesh about the inside at 4000 points, and at both sides of its
/// triangles.
/// @throws Error (kInput) as bakeMesh() does for a mesh without faces, with an index out of range
/// or a vertex that is not finite or far away.
[[nodiscard]] PALPATE_EXPORT FieldPtr polyhedronField(const Mesh& mesh,
                                                      std::size_t most_faces = kMostFlatFaces);

/// The result of withSharpEdges().
struct SharpField {
  FieldPtr field;                ///< the baked field itself if there is no sharp edge
  std::size_t edges = 0;         ///< sharp sides of triangles
  std::size_t left_to_grid = 0;  ///< of these, those where a wall lies inside the solid
  Vec3 place{0.0};               ///< [m] on one such wall
};

/// `baked`, the field of a grid of `mesh` with voxels of `voxel` [m], except within four voxels of
/// edges that turn by more than `angle` [rad, 0 to pi]: there it is the exact signed distance to
/// the triangles. Over the fifth voxel one blends into the other, so that value and gradient have
/// no step. The result is one CSG leaf; contact finds the fold of a hollow edge within it.
///
/// Immutable, and its functions are real-time safe as all fields' are. Costs some 100 bytes for
/// each pair of a triangle near a sharp edge and a cell of two voxels there. Parts (connected by
/// vertices) that lie within the solid are left out, and parts that are inside out are turned, as
/// in the grid. Where parts pass through each other within five voxels of a sharp edge, so that
/// triangles there are not the solid's surface, the grid answers at that edge.
/// @throws Error (kInput): a mesh that is not closed as it comes (mesh.sharp_open), or one all of
/// whose sharp edges would be left to the grid (mesh.sharp_inner, with a place); what bakeMesh()
/// refuses of a mesh.
[[nodiscard]] PALPATE_EXPORT SharpField withSharpEdges(FieldPtr baked, const Mesh& mesh,
                                                       double angle, double voxel);

/// A structure of a body.
struct NamedMesh {
  std::string name;  ///< of the structure; no two may have the same
  Mesh mesh;         ///< its surface
};

/// Meshes, one structure each, as a label image with axes along R, A, S, cubic voxels of `voxel`
/// [m] and two free voxels on every side. A voxel belongs to a mesh if its center is inside by
/// MeshSign::kVote (see bakeMesh()), so the labels' border is within half a voxel's diagonal of the
/// surface. Labels run from 1 in the meshes' order. Where meshes overlap, the one that `priority`
/// names first has the voxel; else the one of fewer voxels.
/// @throws Error: kInput, codes "models.*": two of one name, an image of more than 2^31 voxels;
/// mesh.open and mesh.ambiguous as bakeMesh(); labels.priority; kCancelled.
[[nodiscard]] PALPATE_EXPORT Image labelsOfMeshes(const std::vector<NamedMesh>& meshes,
                                                  double voxel,
                                                  const std::vector<std::string>& priority,
                                                  const Progress& progress = {});

}  // namespace palpate::vdb
