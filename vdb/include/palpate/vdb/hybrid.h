#pragma once
/// Hybrid CSG: a field of which the smooth and costly parts are grids, each on its own, while what has edges,
/// is thin, or is cheap as it is stays analytic. No grid holds an edge (it is off by 11 to 14 degrees there,
/// however small the voxels are); a minimum or maximum taken at the query does.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "palpate/vdb/bake.h"

namespace palpate::vdb {

/// Which parts of a field become grids.
enum class Parts {
  kAuto,      ///< those that a grid holds within the tolerance and answers faster
  kOperands,  ///< all that a grid holds within the tolerance and that are no exact distances
  kWhole,     ///< one grid of everything; edges and thin parts suffer
};

struct HybridOptions {
  /// For all grids alike; the band is made as wide as the sampler needs. `name` is the name of a grid of the whole; that of part 2.1 is `name`/2.1. A
  /// `box` cuts off what reaches out of it, with exact faces.
  BakeOptions bake;
  Parts parts = Parts::kAuto;
  Sampler sampler = Sampler::kCubic;
  /// [m] by how much a grid may be off its part's surface; 0: a fiftieth of a voxel for the cubic sampler, a
  /// tenth for the others. Independent of it, a normal that is off by more than 1 degree (others:
  /// 10) tells an edge. Not for kWhole.
  double tolerance = 0.0;
  /// [m] Grids are made only where this box needs them, and are knownWithin() it.
  Box3 within = Box3::everything();
  /// Fields whose leaves stay analytic whatever else holds, such as those that ports are on. Not for kWhole.
  std::vector<FieldPtr> keep = {};
};

/// What became of one part of the field: a leaf of its CSG, or a solid with faces.
struct HybridPart {
  std::string name;  ///< its place in the tree: 2.1 is the first operand of the second; empty: all
  std::string reason;  ///< why it is what it is, a sentence for people
  LevelSet grid;       ///< in the part's own frame; empty if it stays analytic
  double off =
      0.0;  ///< [m] largest distance measured between the two surfaces; 0: no grid was made
  double turn = 0.0;         ///< [degrees] largest angle measured between their normals
  double analytic_ns = 0.0;  ///< [ns] of a query; 0: not measured
  double grid_ns = 0.0;      ///< [ns] the same for a grid
};

struct Hybrid {
  /// The same tree of unions, intersections, complements and placements. What stays analytic is the same
  /// object as before, so that ports still find it; a subtree in which nothing changed is too.
  FieldPtr field;
  std::vector<HybridPart> parts;
};

/// Every part is baked in its own frame, only where the whole needs it, and once if it occurs twice. With
/// kAuto, queries are timed for some milliseconds, so that a part on the brink may come out either
/// way; the other two always decide alike.
/// @throws Error as bake() does (a part that a grid cannot hold is none, but with kWhole); kInput if
/// `field` is null or `tolerance` negative.
[[nodiscard]] Hybrid bakeHybrid(const FieldPtr& field, const HybridOptions& options,
                                const Progress& progress = {});

/// What bakeHybrid() made of `field` once, out of its grids: each takes the place of the part that the
/// map names it by; all else stays analytic.
/// @throws Error (kInput) if there is no such part, or a grid is off its part by more than smoothGridError()
/// says and the tolerance it was made with: it was made of another field. A hundred blocks of it are looked at.
/// kOperation if the bricks of a grid would take it beyond `max_memory` [bytes]; 0: 80 % of the machine's. `within` as in
/// HybridOptions.
[[nodiscard]] FieldPtr recombined(const FieldPtr& field,
                                  const std::map<std::string, LevelSet>& grids, Sampler sampler,
                                  const Box3& within = Box3::everything(),
                                  std::uint64_t max_memory = 0);

}  // namespace palpate::vdb
