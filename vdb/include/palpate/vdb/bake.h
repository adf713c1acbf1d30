#pragma once
/// Fields and meshes -> narrow-band level sets, in parallel (TBB).

#include <cstdint>
#include <optional>
#include <string>

#include "palpate/vdb/level_set.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// Who tells the inside of a mesh from its outside where a mesh is not one clean closed surface.
enum class MeshSign : std::uint8_t {
  kVote,     ///< both of the following; where they differ, and for large holes, bakeMesh() throws
  kWinding,  ///< inside: the winding number is not 0. Parts turned against the one around are hollows
  kFlood,    ///< inside: whatever cannot be reached from outside; there are no hollows
  kUnsigned  ///< nothing is inside: distances to the closest triangle, of closed and open meshes alike
};

/// Metadata of a grid made by MeshSign::kUnsigned.
inline constexpr const char* kDistanceKey = "distance";
inline constexpr const char* kUnsignedDistance = "unsigned";

struct BakeOptions {
  double voxel_size = 0.0;              ///< [m] must be positive
  double half_width = kCubicHalfWidth;  ///< [voxels] at least 2
  /// [m] where to bake; needed for unbounded fields. What reaches out of it is cut off by its faces,
  /// so that the result is closed.
  std::optional<Box3> box = {};
  std::string name = "surface";
  std::string length_unit = "mm";  ///< unit that the grid's world coordinates are stored in
  std::uint64_t max_memory = 0;    ///< [bytes] 0: 80 % of the machine's
  std::map<std::string, std::string> metadata = {};
  MeshSign mesh_sign = MeshSign::kVote;  ///< of bakeMesh()
  /// [m] of bakeMesh(): if positive, the mesh is no solid but a surface, closed or not, in the middle
  /// of a shell of that thickness.
  double shell_thickness = 0.0;
  /// [rad] of bakeMesh(), up to pi: if positive, facets that meet at less than this angle become pieces of one
  /// smooth surface through the vertices. For scans and balls whose facets are larger than about 1.5
  /// voxels and would be felt; edges that are steeper stay.
  double smooth_angle = 0.0;
};

/// Voxel (0, 0, 0) has its centre at the origin. Values are the field's own if it is exact or a
/// bound; the exact distance by projection if it is implicit (footPoint(); S / |grad S| where no
/// nearest point is found); and, unless it is exact, more than that far out, so that the band ends
/// within its half width of the field's bounds.
/// Active are the voxels with |value| less than half_width voxels. The result does not depend on the
/// number of threads.
/// Wires and separate parts too thin for the voxels are missing: the metadata `lost_parts` tells how thin and where.
/// @throws Error: kInput for options or an empty result (a shape the voxels cannot hold), kOperation
/// for memory, kCancelled.
[[nodiscard]] LevelSet bake(const Field& field, const BakeOptions& options,
                            const Progress& progress = {});

/// A solid out of a mesh as it comes. Values are the distance to the closest triangle, to 1e-5 voxel;
/// the result does not depend on the number of threads.
///
/// Vertices in one place are joined (where edges are open, also those within 4e-5 of the mesh's
/// size), doubled triangles dropped, triangles turned as most of their
/// neighbors are; holes get lids of least area, open parts that are too small for the voxels are dropped
/// (`lost_parts` says how many). Parts that overlap are one solid, a part within another
/// one and turned against it is a cavity, a mesh that is inside out is the same mesh.
/// `lost_parts` as of bake().
///
/// By MeshSign::kUnsigned only the checks and the joining of vertices are done, and values are never negative. The
/// grid's class is OpenVDB's `unknown` and its metadata say `distance: unsigned`: nothing of it can be touched
/// before it is offset, which makes a shell of any thickness (of two voxels or more: there is a kink in the middle).
/// @throws Error: kInput, naming a place, for a mesh without faces, with an index out of range, a vertex
/// that is not finite or a thousand times farther out than the rest, with lids that make up more
/// than an eighth of a part's surface, about which winding number and flood differ, or with a plate or shell
/// so thin that the grid would have holes; kOperation for memory; kCancelled.
[[nodiscard]] LevelSet bakeMesh(const Mesh& mesh, const BakeOptions& options,
                                const Progress& progress = {});

}  // namespace palpate::vdb
