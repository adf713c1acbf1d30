#pragma once
/// Bakes fields and meshes to narrow-band level sets, in parallel (TBB). Also hybrid CSG: the
/// smooth and costly parts of a field become grids, one each; parts that have edges, are thin, or
/// are already cheap stay analytic. No grid holds an edge (its normals are off by 11 to 14 degrees
/// there, however small the voxels are); a minimum or maximum taken at the query does.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "palpate/export.h"
#include "palpate/vdb/level_set.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {

/// Which rule tells the inside of a mesh from its outside where the mesh is not one clean closed
/// surface.
enum class MeshSign : std::uint8_t {
  kVote,     ///< both of the following; where they differ, and for large holes, bakeMesh() throws
  kWinding,  ///< inside: the winding number is not 0. Parts turned against the part around them are
             ///< cavities
  kFlood,    ///< inside: whatever cannot be reached from outside; there are no hollows
  kUnsigned  ///< nothing is inside: unsigned distances to the closest triangle, for closed and open
             ///< meshes alike
};

/// Metadata of a grid made by MeshSign::kUnsigned.
inline constexpr const char* kDistanceKey = "distance";
/// The value of kDistanceKey in such a grid.
inline constexpr const char* kUnsignedDistance = "unsigned";

/// How to bake a grid of a field, a mesh or a scan.
struct BakeOptions {
  double voxel_size = 0.0;              ///< [m] must be positive
  double half_width = kCubicHalfWidth;  ///< [voxels] at least 2
  /// [m] where to bake; needed for unbounded fields. A shape that reaches beyond the box is cut off
  /// by its faces, so that the result is closed.
  std::optional<Box3> box = {};
  std::string name = "surface";    ///< name of the grid; a scene's layers use `<layer>/surface`
  std::string length_unit = "mm";  ///< unit that the grid's world coordinates are stored in
  std::uint64_t max_memory = 0;    ///< [bytes] 0: 80 % of the machine's
  /// Entries for the grid's metadata: source, layer, ...
  std::map<std::string, std::string> metadata = {};
  MeshSign mesh_sign = MeshSign::kVote;  ///< of bakeMesh()
  /// [m] for bakeMesh(): if positive, the mesh is not a solid but a surface, closed or not, in the
  /// middle of a shell of that thickness.
  double shell_thickness = 0.0;
  /// [rad] for bakeMesh(), up to pi: if positive, facets that meet at less than this angle become
  /// pieces of one smooth surface through the vertices; steeper edges stay. For scans and balls
  /// whose facets are larger than about 1.5 voxels, so that the hand would feel them.
  double smooth_angle = 0.0;
};

/// Voxel (0, 0, 0) has its center at the origin. Values are the field's own if it is exact or a
/// bound. For an implicit field they are the exact distance by projection (footPoint(); S / |grad
/// S| where it finds no nearest point). Unless the field is exact, values far out are raised, so
/// that the band ends within its half width of the field's bounds.
/// Active are the voxels with |value| less than half_width voxels. The result does not depend on
/// the number of threads. Wires and separate parts too thin for the voxels are missing from the
/// grid: the metadata `lost_parts` tells how thin they are and where.
/// @throws Error: kInput for options or an empty result (a shape the voxels cannot hold),
/// kOperation for memory, kCancelled.
[[nodiscard]] PALPATE_EXPORT LevelSet bake(const Field& field, const BakeOptions& options,
                                           const Progress& progress = {});

/// Makes a solid from a mesh as it was read. Values are the distance to the closest triangle, to
/// 1e-5 voxel; the result does not depend on the number of threads.
///
/// Vertices at the same place are joined (where edges are open, also those within 4e-5 of the
/// mesh's size), doubled triangles are dropped, and triangles are turned the way most of their
/// neighbors are. Holes get lids of least area; open parts that are too small for the voxels are
/// dropped (`lost_parts` says how many). Parts that overlap form one solid; a part inside another
/// and turned against it is a cavity; a mesh that is inside out is turned the right way.
/// `lost_parts` as for bake().
///
/// With MeshSign::kUnsigned the mesh is only checked and its vertices joined, and values are never
/// negative. The grid's class is OpenVDB's `unknown` and its metadata say `distance: unsigned`: it
/// cannot be touched before an offset makes a shell of it, of any thickness from two voxels up
/// (thinner ones contain the kink in the middle).
/// @throws Error: kInput, naming a place, for a mesh without faces, with an index out of range,
/// with a vertex that is not finite or is a thousand times farther out than the rest, with lids
/// that make up more than an eighth of a part's surface, with regions that winding number and flood
/// fill judge differently, or with a plate or shell so thin that the grid would have holes;
/// kOperation for memory; kCancelled.
[[nodiscard]] PALPATE_EXPORT LevelSet bakeMesh(const Mesh& mesh, const BakeOptions& options,
                                               const Progress& progress = {});

/// Which parts of a field become grids.
enum class Parts {
  kAuto,  ///< those that a grid holds within the tolerance and answers faster than the field does
  kOperands,  ///< all that a grid holds within the tolerance, except exact distances
  kWhole,     ///< one grid of the whole field; edges and thin parts suffer
};

/// The settings of bakeHybrid().
struct HybridOptions {
  /// Options for all grids alike; the band is made as wide as the sampler needs. `name` is the name
  /// of a grid of the whole field; the grid of part 2.1 is called `name`/2.1. A `box` cuts off,
  /// with exact faces, whatever reaches beyond it.
  BakeOptions bake;
  Parts parts = Parts::kAuto;         ///< which parts become grids
  Sampler sampler = Sampler::kCubic;  ///< how the grids will be read
  /// [m] by how much a grid's surface may be off its part's; 0: a fiftieth of a voxel for the cubic
  /// sampler, a tenth for the others. Independently of it, a normal that is off by more than 1
  /// degree (other samplers: 10) counts as an edge. Not for kWhole.
  double tolerance = 0.0;
  /// [m] Grids are made only as far as this box needs them, and are knownWithin() it.
  Box3 within = Box3::everything();
  /// Fields whose leaves stay analytic whatever else holds, such as those that ports are on. Not
  /// for kWhole.
  std::vector<FieldPtr> keep = {};
};

/// What bakeHybrid() decided about one part of the field: a leaf of its CSG, or a solid with faces.
struct HybridPart {
  std::string name;  ///< place in the tree: 2.1 is the first operand of the second operand; empty:
                     ///< the whole
  std::string reason;  ///< why it became a grid or stayed analytic, a sentence for people
  LevelSet grid;       ///< in the part's own frame; empty if it stays analytic
  double off =
      0.0;  ///< [m] largest distance measured between the two surfaces; 0: no grid was made
  double turn = 0.0;         ///< [degrees] largest angle measured between their normals
  double analytic_ns = 0.0;  ///< [ns] time of a query; 0: not measured
  double grid_ns = 0.0;      ///< [ns] the same for the grid
};

/// The result of bakeHybrid().
struct Hybrid {
  /// The same tree of unions, intersections, complements and placements. A part that stays analytic
  /// is the same object as before, so that ports still find it; so is a subtree in which nothing
  /// changed.
  FieldPtr field;
  std::vector<HybridPart> parts;  ///< all parts, those that stay analytic too
};

/// Bakes every part in its own frame, only where the whole needs it, and once if it occurs twice.
/// kAuto times queries for some milliseconds, so that a part that answers about equally fast both
/// ways may come out either way; the other two choices always decide alike.
/// @throws Error as bake() does (but a part that a grid cannot hold stays analytic, unless the
/// choice is kWhole); kInput if `field` is null or `tolerance` is negative.
[[nodiscard]] PALPATE_EXPORT Hybrid bakeHybrid(const FieldPtr& field, const HybridOptions& options,
                                               const Progress& progress = {});

/// Rebuilds what an earlier bakeHybrid() made of `field` from its grids: each grid replaces the
/// part whose name is its key in `grids`; all else stays analytic. `within` as in HybridOptions.
/// @throws Error (kInput) if there is no such part, or if a grid is off its part by more than
/// smoothGridError() and the tolerance it was made with, which shows that it was made from another
/// field (a hundred blocks of the grid are compared); kOperation if a grid with its bricks would
/// take more than `max_memory` [bytes]; 0: 80 % of the machine's.
[[nodiscard]] PALPATE_EXPORT FieldPtr recombined(const FieldPtr& field,
                                                 const std::map<std::string, LevelSet>& grids,
                                                 Sampler sampler,
                                                 const Box3& within = Box3::everything(),
                                                 std::uint64_t max_memory = 0);

}  // namespace palpate::vdb
