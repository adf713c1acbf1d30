#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "bake/bake_plan.h"
#include "bake/lost_plates.h"
#include "palpate/fields/foot_point.h"
#include "palpate/vdb/bake.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Leaf = openvdb::FloatTree::LeafNodeType;

enum class Verdict : std::uint8_t { kOutside, kInside, kKeep };

/// The distance that is baked: the field's value, made a distance where it is none. A field that is
/// not exact can fall short of the distance to its own bounds, and would have a band without end
/// there: so that it ends, values rise with twice that distance to the band's width. Near the surface
/// the field stays as smooth as it is, also where its bounds touch it. And a box may cut it off.
class Source {
 public:
  Source(const Field& field, const Box3& domain, bool is_cut, double band)
      : field_(field),
        band_(band),
        domain_(domain),
        is_cut_(is_cut),
        implicit_(field.metric() == Metric::kImplicit),
        exact_(field.metric() == Metric::kExact),
        lipschitz_(field.lipschitz()),
        lipschitz_domain_(field.lipschitzDomain()) {}

  struct Value {
    double distance;
    bool known;  ///< false: only the sign counts
  };

  [[nodiscard]] Value at(const Vec3& p) const noexcept {
    Value result = fieldAt(p);
    if (is_cut_ || !exact_) {
      double wall = boxDistance(p);
      if (!is_cut_ && wall < band_) wall = 2.0 * wall - band_;
      if (wall > result.distance && (is_cut_ || wall > 0.0)) {
        // A known wall decides over a field that is inside, however deep; elsewhere it is a bound.
        result = {wall, result.known || (is_cut_ && result.distance < 0.0)};
      }
    }
    return result;
  }

  /// Whether every point within `radius` of `center` is more than `band` away from the surface.
  /// |S(p)| >= |S(center)| - L radius, and S / |grad S| is at least |S| / L.
  [[nodiscard]] Verdict judge(const Vec3& center, double radius, double band) const noexcept {
    // A billionth covers the rounding of positions and values.
    const double reach = (radius + band) * (1.0 + 1e-9);
    Verdict verdict = Verdict::kKeep;
    if (lipschitz_domain_.contains(center - Vec3(radius)) &&
        lipschitz_domain_.contains(center + Vec3(radius))) {
      const double value = field_.value(center);
      if (std::abs(value) > lipschitz_ * reach) {
        verdict = value > 0.0 ? Verdict::kOutside : Verdict::kInside;
      }
    }
    if (is_cut_ && verdict != Verdict::kOutside) {
      const double wall = boxDistance(center);
      if (wall > reach) return Verdict::kOutside;
      if (wall >= -reach) return Verdict::kKeep;
    }
    return verdict;
  }

 private:
  [[nodiscard]] Value fieldAt(const Vec3& p) const noexcept {
    if (!implicit_) return {field_.value(p), true};
    const FieldSample sample = field_.sample(p);
    if (!sample.in_band) return {sample.value, false};
    const double slope = glm::length(sample.gradient);
    // Where the gradient vanishes the quotient says "far away", which is all the band needs.
    const double near = sample.value == 0.0 ? 0.0 : sample.value / slope;
    // Off by second order in the distance. The exact one is worth its time only in the band, for which a
    // quotient twice as large leaves room.
    if (std::abs(near) > 2.0 * band_) return {near, true};
    const auto foot = footPoint(field_, p);
    return {foot ? foot->distance : near, true};
  }

  [[nodiscard]] double boxDistance(const Vec3& p) const noexcept {
    const Vec3 q = glm::max(domain_.lo - p, p - domain_.hi);
    const double inside = std::min(std::max({q.x, q.y, q.z}), 0.0);
    return glm::length(glm::max(q, Vec3(0.0))) + inside;
  }

  const Field& field_;
  double band_;  ///< [m]
  Box3 domain_;
  bool is_cut_;
  bool implicit_;
  bool exact_;
  double lipschitz_;
  Box3 lipschitz_domain_;
};

class FieldBaker {
 public:
  FieldBaker(const Field& field, const BakeOptions& options, const Progress& progress)
      : field_(field),
        options_(options),
        progress_(progress),
        plan_(checkOptions(options)),
        domain_(bakeDomain(field, options)),
        source_(field, domain_, isCut(field, options), plan_.band) {}

  LevelSet run() {
    const std::vector<Coord> origins = findLeaves();
    grid_ = emptyGrid(plan_, options_);
    for (const auto& [origin, size] : inside_) fillInside(origin, size);
    fillLeaves(origins);
    report(progress_, "bake", 1.0);
    LevelSet grid = finishGrid(grid_, plan_, options_);
    refuseLostPlates(field_, grid, plan_, options_);
    return grid;
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

  [[nodiscard]] Verdict judge(const Coord& origin, int size) const noexcept {
    const double half = 0.5 * (size - 1);
    return source_.judge(position(origin.x() + half, origin.y() + half, origin.z() + half),
                         std::sqrt(3.0) * half * plan_.voxel, plan_.band);
  }

  static int alignedDown(int value, int size) { return value & ~(size - 1); }

  /// Blocks at the top of the hierarchy: few, so that the first level costs nothing.
  static std::pair<std::vector<Coord>, int> topBlocks(const CoordBBox& range) {
    int size = 8;
    while (size < (1 << 30) && range.dim()[range.maxExtent()] / size >= 16) size *= 2;
    std::vector<Coord> blocks;
    const Coord lo(alignedDown(range.min().x(), size), alignedDown(range.min().y(), size),
                   alignedDown(range.min().z(), size));
    for (int x = lo.x(); x <= range.max().x(); x += size) {
      for (int y = lo.y(); y <= range.max().y(); y += size) {
        for (int z = lo.z(); z <= range.max().z(); z += size) blocks.emplace_back(x, y, z);
      }
    }
    return {std::move(blocks), size};
  }

  /// Blocks of 8^3 voxels that the band can touch. Blocks inside are noted on the way.
  std::vector<Coord> findLeaves() {
    const CoordBBox range = voxelRange(domain_, plan_, options_.name);
    auto top = topBlocks(range);
    std::vector<Coord> blocks = std::move(top.first);
    int size = top.second;
    std::vector<Verdict> verdicts;
    for (;; size /= 2) {
      verdicts.assign(blocks.size(), Verdict::kKeep);
      parallelWithProgress(blocks.size(), progress_, "bake: finding the surface", 0.0, 0.0,
                           [&](std::size_t i) { verdicts[i] = judge(blocks[i], size); });
      std::vector<Coord> kept;
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (verdicts[i] == Verdict::kKeep) kept.push_back(blocks[i]);
        if (verdicts[i] == Verdict::kInside) inside_.emplace_back(blocks[i], size);
      }
      refuseIfTooLarge(kept.size(), size);
      if (size == 8) return kept;
      blocks = split(kept, size / 2, range);
    }
  }

  static std::vector<Coord> split(const std::vector<Coord>& blocks, int size,
                                  const CoordBBox& range) {
    std::vector<Coord> parts;
    parts.reserve(8 * blocks.size());
    for (const Coord& block : blocks) {
      for (int n = 0; n < 8; ++n) {
        const Coord part = block.offsetBy((n >> 2) * size, ((n >> 1) & 1) * size, (n & 1) * size);
        if (range.hasOverlap(CoordBBox::createCube(part, size))) parts.push_back(part);
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

  void fillInside(const Coord& origin, int size) {
    if (size == 8) {
      grid_->tree().addTile(1, origin, -plan_.background, false);
    } else {
      grid_->tree().sparseFill(CoordBBox::createCube(origin, size), -plan_.background, false);
    }
  }

  void fillLeaves(const std::vector<Coord>& origins) {
    std::vector<std::unique_ptr<Leaf>> leaves(origins.size());
    std::vector<Verdict> verdicts(origins.size());
    std::atomic<bool> broken = false;
    parallelWithProgress(origins.size(), progress_, "bake", 0.0, 1.0, [&](std::size_t i) {
      leaves[i] = std::make_unique<Leaf>(origins[i], plan_.background, false);
      verdicts[i] = fillLeaf(*leaves[i], broken);
      if (verdicts[i] != Verdict::kKeep) leaves[i].reset();
    });
    if (broken) {
      throw inputError("bake.not_finite", "the field of '" + options_.name +
                                              "' is not a number somewhere in its bounds");
    }
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (verdicts[i] == Verdict::kKeep) grid_->tree().addLeaf(leaves[i].release());
      if (verdicts[i] == Verdict::kInside) fillInside(origins[i], 8);
    }
  }

  /// Evaluates the sub-blocks of 4^3 voxels that the band can touch.
  Verdict fillLeaf(Leaf& leaf, std::atomic<bool>& broken) const noexcept {
    constexpr int kPart = 4;
    float* const values = leaf.buffer().data();
    const float background = plan_.background;
    bool any_inside = false, any_outside = false, any_active = false;
    for (int n = 0; n < 8; ++n) {
      const Coord local((n >> 2) * kPart, ((n >> 1) & 1) * kPart, (n & 1) * kPart);
      const Coord origin = leaf.origin() + local;
      const Verdict verdict = judge(origin, kPart);
      for (int x = 0; x < kPart; ++x) {
        for (int y = 0; y < kPart; ++y) {
          for (int z = 0; z < kPart; ++z) {
            const openvdb::Index at = Leaf::coordToOffset(local.offsetBy(x, y, z));
            float value = verdict == Verdict::kInside ? -background : background;
            if (verdict == Verdict::kKeep) {
              const Source::Value found =
                  source_.at(position(origin.x() + x, origin.y() + y, origin.z() + z));
              const auto stored = static_cast<float>(found.distance / plan_.metres_per_unit);
              if (std::isnan(stored)) broken.store(true, std::memory_order_relaxed);
              const bool active = found.known && std::abs(stored) < background;
              value = active ? stored : std::copysign(background, stored);
              if (active) leaf.setValueOn(at);
              any_active = any_active || active;
            }
            values[at] = value;
            any_inside = any_inside || value < 0.0F;
            any_outside = any_outside || value > 0.0F;
          }
        }
      }
    }
    if (any_active || (any_inside && any_outside)) return Verdict::kKeep;
    return any_inside ? Verdict::kInside : Verdict::kOutside;
  }

  const Field& field_;
  const BakeOptions& options_;
  const Progress& progress_;
  BakePlan plan_;
  Box3 domain_;  ///< [m] holds the surface
  Source source_;
  std::vector<std::pair<Coord, int>> inside_;  ///< blocks and their sizes
  openvdb::FloatGrid::Ptr grid_;
};

}  // namespace

LevelSet bake(const Field& field, const BakeOptions& options, const Progress& progress) {
  return FieldBaker(field, options, progress).run();
}

}  // namespace palpate::vdb
