#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/band_source.h"
#include "bake/band_tree.h"
#include "bake/leaf_values.h"
#include "bake/lost_plates.h"
#include "palpate/vdb/bake.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

class FieldBaker {
 public:
  FieldBaker(const Field& field, const BakeOptions& options, const Progress& progress)
      : field_(field),
        options_(options),
        progress_(progress),
        plan_(checkOptions(options)),
        units_per_metre_(1.0 / plan_.metres_per_unit),
        domain_(bakeDomain(field, options)),
        source_(field, domain_, isCut(field, options), plan_.band) {}

  LevelSet run() {
    findLeaves();
    std::vector<std::unique_ptr<BandLeaf>> leaves = makeLeaves();
    const openvdb::FloatGrid::Ptr grid = emptyGrid(plan_, options_);
    std::vector<Coord> origins;
    origins.reserve(cells_.size());
    for (const Cell& cell : cells_) origins.push_back(cell.origin);
    fillTree(grid->tree(), origins, std::move(leaves), inside_);
    report(progress_, "bake", 1.0);
    const LevelSet made = finishGrid(grid, plan_, options_);
    return withLostParts(made, refuseLostPlates(field_, made, plan_, options_));
  }

 private:
  /// Where the surface is.
  static Box3 bakeDomain(const Field& field, const BakeOptions& options) {
    Box3 domain = field.bounds();
    if (options.box) domain = domain.intersectedWith(*options.box);
    if (domain.isEmpty()) {
      throw inputError("bake.empty",
                       "nothing to bake as '" + options.name + "': the shape is empty" +
                           (options.box ? ", or lies outside the box to bake in" : ""));
    }
    if (!domain.isBounded()) {
      throw inputError("bake.unbounded",
                       "'" + options.name + "' reaches to infinity and cannot be baked whole",
                       "give a box to bake in, or keep the field analytic");
    }
    return domain;
  }

  /// A box that holds the whole shape cuts nothing off.
  static bool isCut(const Field& field, const BakeOptions& options) {
    if (!options.box) return false;
    const Box3 bounds = field.bounds();
    return !options.box->contains(bounds.lo) || !options.box->contains(bounds.hi);
  }

  [[nodiscard]] Vec3 position(double i, double j, double k) const noexcept {
    return Vec3(i, j, k) * plan_.voxel;
  }

  [[nodiscard]] Verdict judge(const Coord& origin, int size, const FieldPart& from,
                              bool only_in_band, FieldPart& to) const {
    return source_.judge(from, centerOf(origin, size), radiusOf(size), only_in_band, to);
  }
  [[nodiscard]] Vec3 centerOf(const Coord& origin, int size) const noexcept {
    const double half = 0.5 * (size - 1);
    return position(origin.x() + half, origin.y() + half, origin.z() + half);
  }
  /// [m] from a cube's center to the voxels at its corners.
  [[nodiscard]] double radiusOf(int size) const noexcept {
    return std::sqrt(3.0) * 0.5 * (size - 1) * plan_.voxel;
  }

  static int alignedDown(int value, int size) { return value & ~(size - 1); }

  /// A cube that the band can touch, and what decides about the field there.
  struct Cell {
    Coord origin;
    std::uint32_t part = 0;  ///< index into parts_
  };

  /// Cells at the top of the hierarchy: few, so that the first level costs nothing.
  static std::pair<std::vector<Cell>, int> topCells(const CoordBBox& range) {
    int size = 8;
    while (size < (1 << 30) && range.dim()[range.maxExtent()] / size >= 4) size *= 2;
    std::vector<Cell> cells;
    const Coord lo(alignedDown(range.min().x(), size), alignedDown(range.min().y(), size),
                   alignedDown(range.min().z(), size));
    for (int x = lo.x(); x <= range.max().x(); x += size) {
      for (int y = lo.y(); y <= range.max().y(); y += size) {
        for (int z = lo.z(); z <= range.max().z(); z += size) cells.push_back({{x, y, z}, 0});
      }
    }
    return {std::move(cells), size};
  }

  /// Puts the blocks of 8^3 voxels that the band can touch into cells_, those inside into inside_.
  void findLeaves() {
    const CoordBBox range = voxelRange(domain_, plan_, options_.name);
    std::pair<std::vector<Cell>, int> top = topCells(range);
    std::vector<Cell>& cells = top.first;
    int& size = top.second;
    parts_.assign(1, source_.whole());
    std::vector<Verdict> verdicts;
    std::vector<FieldPart> left;  // empty where it is that of the cell before
    for (;; size /= 2) {
      verdicts.assign(cells.size(), Verdict::kKeep);
      // Leaves are judged once more when they are filled; what they need not keep, is not kept.
      const bool is_narrowed = size > 8 && source_.whole().nodes.size() > 1;
      left.assign(is_narrowed ? cells.size() : 0, {});
      parallelWithProgress(
          cells.size(), progress_, "bake: finding the surface", 0.0, 0.0, [&](std::size_t i) {
            verdicts[i] = judgeCell(cells[i], size, is_narrowed ? &left[i] : nullptr);
          });
      std::vector<Cell> kept;
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (verdicts[i] == Verdict::kInside) inside_.push_back({cells[i].origin, size});
        if (verdicts[i] != Verdict::kKeep) continue;
        kept.push_back(cells[i]);
        if (!is_narrowed || left[i].nodes.empty()) continue;
        kept.back().part = static_cast<std::uint32_t>(parts_.size());
        parts_.push_back(std::move(left[i]));
      }
      refuseIfTooLarge(kept.size(), size);
      if (size == 8) {
        cells_ = std::move(kept);
        return;
      }
      cells = split(kept, size / 2, range);
    }
  }

  /// `left`, if there is one: what decides in the cell, if that is less than in the one before.
  [[nodiscard]] Verdict judgeCell(const Cell& cell, int size, FieldPart* left) const {
    thread_local FieldPart here;
    const FieldPart& before = parts_[cell.part];
    const Verdict verdict = judge(cell.origin, size, before, false, here);
    if (left != nullptr && verdict == Verdict::kKeep && here.nodes.size() < before.nodes.size()) {
      *left = here;
    }
    return verdict;
  }

  static std::vector<Cell> split(const std::vector<Cell>& cells, int size, const CoordBBox& range) {
    std::vector<Cell> parts;
    parts.reserve(8 * cells.size());
    for (const Cell& cell : cells) {
      for (int n = 0; n < 8; ++n) {
        const Coord origin =
            cell.origin.offsetBy((n >> 2) * size, ((n >> 1) & 1) * size, (n & 1) * size);
        if (range.hasOverlap(CoordBBox::createCube(origin, size))) {
          parts.push_back({origin, cell.part});
        }
      }
    }
    return parts;
  }

  /// Blocks are kept in a shell of their half diagonal and the band on both sides of the surface, so
  /// that their number at any size tells the surface's area, and that the number of leaves. Early
  /// levels are coarse and judge with a wide margin.
  void refuseIfTooLarge(std::size_t blocks, int size) const {
    const double shell = std::sqrt(3.0) * (size - 1.0) + 2.0 * options_.half_width;
    const double area = static_cast<double>(blocks) * std::pow(size, 3) / shell;
    constexpr std::size_t kEnoughToCount = 20000;
    const double margin = size == 8 ? 1.0 : 8.0;
    if (size == 8 || blocks > kEnoughToCount) requireMemory(area, margin, plan_);
  }

  /// One for each cell; null where no voxel is active and all have one sign.
  std::vector<std::unique_ptr<BandLeaf>> makeLeaves() {
    std::vector<std::unique_ptr<BandLeaf>> leaves(cells_.size());
    std::vector<Verdict> verdicts(cells_.size());
    std::atomic<bool> broken = false;
    parallelWithProgress(cells_.size(), progress_, "bake", 0.0, 1.0, [&](std::size_t i) {
      LeafValues values;
      verdicts[i] = fillLeaf(cells_[i], values);
      if (values.is_broken) broken.store(true, std::memory_order_relaxed);
      if (verdicts[i] == Verdict::kKeep) leaves[i] = values.leafAt(cells_[i].origin, background());
    });
    if (broken) {
      throw inputError("bake.not_finite", "the field of '" + options_.name +
                                              "' is not a number somewhere in its bounds");
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (verdicts[i] == Verdict::kInside) inside_.push_back({cells_[i].origin, 8});
    }
    return leaves;
  }

  [[nodiscard]] float background() const noexcept { return plan_.background; }

  /// Evaluates the sub-blocks of 4^3 voxels that the band can touch.
  Verdict fillLeaf(const Cell& cell, LeafValues& leaf) const {
    thread_local FieldPart in_leaf;
    thread_local FieldPart in_block;
    const Verdict whole = judge(cell.origin, 8, parts_[cell.part], true, in_leaf);
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
      const std::uint64_t known =
          source_.values(in_block, points, centerOf(origin, 4), radiusOf(4), distances);
      leaf.store(local, distances, known, units_per_metre_, background());
    }
    if (leaf.any_active || (leaf.any_inside && leaf.any_outside)) return Verdict::kKeep;
    return leaf.any_inside ? Verdict::kInside : Verdict::kOutside;
  }

  const Field& field_;
  const BakeOptions& options_;
  const Progress& progress_;
  BakePlan plan_;
  double units_per_metre_;
  Box3 domain_;  ///< [m] holds the surface
  BandSource source_;
  std::vector<FieldPart> parts_;  ///< what decides in the cells of all levels
  std::vector<Cell> cells_;       ///< of 8^3 voxels
  std::vector<BandBlock> inside_;
};

}  // namespace

LevelSet bake(const Field& field, const BakeOptions& options, const Progress& progress) {
  return FieldBaker(field, options, progress).run();
}

}  // namespace palpate::vdb
