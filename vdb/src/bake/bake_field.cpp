#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/band_source.h"
#include "bake/band_tree.h"
#include "bake/cube_search.h"
#include "bake/implicit_distances.h"
#include "bake/leaf_values.h"
#include "bake/lost_plates.h"
#include "palpate/vdb/bake.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

/// A box that holds the surface.
Box3 bakeDomain(const Field& field, const BakeOptions& options) {
  Box3 domain = field.bounds();
  if (options.box) domain = domain.intersectedWith(*options.box);
  if (domain.isEmpty()) {
    throw inputError("bake.empty", "nothing to bake as '" + options.name + "': the shape is empty" +
                                       (options.box ? ", or lies outside the box to bake in" : ""));
  }
  if (!domain.isBounded()) {
    throw inputError("bake.unbounded",
                     "'" + options.name + "' reaches to infinity and cannot be baked whole",
                     "give a box to bake in, or keep the field analytic");
  }
  return domain;
}

/// Whether the box cuts something off: one that holds the whole shape does not.
bool isCut(const Field& field, const BakeOptions& options) {
  if (!options.box) return false;
  const Box3 bounds = field.bounds();
  return !options.box->contains(bounds.lo) || !options.box->contains(bounds.hi);
}

/// Bakes a field whose values are distances, or bounds of them.
class FieldBaker {
 public:
  FieldBaker(const Field& field, const Box3& domain, const BakePlan& plan,
             const BakeOptions& options, const Progress& progress)
      : options_(options),
        progress_(progress),
        plan_(plan),
        units_per_meter_(1.0 / plan_.meters_per_unit),
        domain_(domain),
        source_(field, domain_, isCut(field, options), plan_.band),
        search_(source_, plan_, 2.0 * plan_.half_width) {}

  openvdb::FloatGrid::Ptr run() {
    search_.run(voxelRange(domain_, plan_, options_.name), progress_);
    std::vector<std::unique_ptr<BandLeaf>> leaves = makeLeaves();
    openvdb::FloatGrid::Ptr grid = emptyGrid(plan_, options_);
    std::vector<Coord> origins;
    origins.reserve(leaves.size());
    for (const CubeSearch::Cube& cube : search_.cubes()) origins.push_back(cube.origin);
    fillTree(grid->tree(), origins, std::move(leaves), search_.inside());
    return grid;
  }

 private:
  [[nodiscard]] Vec3 position(double i, double j, double k) const noexcept {
    return Vec3(i, j, k) * plan_.voxel;
  }

  [[nodiscard]] Verdict judge(const Coord& origin, int size, const FieldPart& from,
                              bool only_in_band, FieldPart& to) const {
    return source_.judge(from, search_.centerOf(origin, size), search_.radiusOf(size), only_in_band,
                         to);
  }

  /// One leaf for each cell; null where no voxel is active and all have one sign.
  std::vector<std::unique_ptr<BandLeaf>> makeLeaves() {
    const std::vector<CubeSearch::Cube>& cubes = search_.cubes();
    std::vector<std::unique_ptr<BandLeaf>> leaves(cubes.size());
    std::vector<Verdict> verdicts(cubes.size());
    std::atomic<bool> broken = false;
    parallelWithProgress(cubes.size(), progress_, "bake", 0.0, 1.0, [&](std::size_t i) {
      LeafValues values;
      verdicts[i] = fillLeaf(cubes[i], values);
      if (values.is_broken) broken.store(true, std::memory_order_relaxed);
      if (verdicts[i] == Verdict::kKeep) leaves[i] = values.leafAt(cubes[i].origin, background());
    });
    if (broken) {
      throw inputError("bake.not_finite", "the field of '" + options_.name +
                                              "' is not a number somewhere in its bounds");
    }
    for (std::size_t i = 0; i < cubes.size(); ++i) {
      if (verdicts[i] == Verdict::kInside) search_.inside().push_back({cubes[i].origin, 8});
    }
    return leaves;
  }

  [[nodiscard]] float background() const noexcept { return plan_.background; }

  /// Evaluates the sub-blocks of 4^3 voxels that the band can touch.
  Verdict fillLeaf(const CubeSearch::Cube& cell, LeafValues& leaf) const {
    thread_local FieldPart in_leaf;
    thread_local FieldPart in_block;
    const Verdict whole = judge(cell.origin, 8, search_.partOf(cell), true, in_leaf);
    if (whole != Verdict::kKeep) return whole;
    for (int n = 0; n < 8; ++n) {
      const Coord local((n >> 2) * 4, ((n >> 1) & 1) * 4, (n & 1) * 4);
      const Coord origin = cell.origin + local;
      const Verdict verdict = judge(origin, 4, in_leaf, true, in_block);
      if (verdict != Verdict::kKeep) {
        leaf.fill(local, verdict == Verdict::kInside ? -background() : background());
        continue;
      }
      PointBatch points;
      for (int x = 0; x < 4; ++x) {
        for (int y = 0; y < 4; ++y) {
          const std::size_t first =
              16 * static_cast<std::size_t>(x) + 4 * static_cast<std::size_t>(y);
          for (int z = 0; z < 4; ++z) {
            const Vec3 p = position(origin.x() + x, origin.y() + y, origin.z() + z);
            points.x[first + static_cast<std::size_t>(z)] = p.x;
            points.y[first + static_cast<std::size_t>(z)] = p.y;
            points.z[first + static_cast<std::size_t>(z)] = p.z;
          }
        }
      }
      ValueBatch distances;
      source_.values(in_block, points, search_.centerOf(origin, 4), search_.radiusOf(4), distances);
      leaf.store(local, distances, units_per_meter_, background());
    }
    if (leaf.any_active || (leaf.any_inside && leaf.any_outside)) return Verdict::kKeep;
    return leaf.any_inside ? Verdict::kInside : Verdict::kOutside;
  }

  const BakeOptions& options_;
  const Progress& progress_;
  const BakePlan& plan_;
  double units_per_meter_;
  Box3 domain_;  ///< [m] holds the surface
  BandSource source_;
  CubeSearch search_;
};

}  // namespace

LevelSet bake(const Field& field, const BakeOptions& options, const Progress& progress) {
  const BakePlan plan = checkOptions(options);
  const Box3 domain = bakeDomain(field, options);
  const openvdb::FloatGrid::Ptr grid =
      field.metric() == Metric::kImplicit
          ? implicitDistances(field, {domain, isCut(field, options)}, plan, options, progress)
          : FieldBaker(field, domain, plan, options, progress).run();
  report(progress, "bake", 1.0);
  const LevelSet made = finishGrid(grid, plan, options);
  return withLostParts(made, refuseLostPlates(field, made, plan, options));
}

}  // namespace palpate::vdb
