#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/bake_plan.h"
#include "brick/brick_field.h"
#include "grid/survey.h"
#include "palpate/fields/csg.h"
#include "palpate/vdb/grid_memory.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
/// This accessor is not registered with its tree, because registering takes a lock. It need not be:
/// the tree never changes.
using Accessor = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;

/// Eight voxels around a point: bit 2 of the index steps along x, bit 1 along y, bit 0 along z.
struct Cell {
  std::array<float, 8> values{};
  unsigned active = 0;  ///< a bit for each
};

Cell readCell(const Accessor& accessor, const Coord& base) noexcept {
  Cell cell;
  constexpr int kLast = static_cast<int>(Leaf::DIM) - 1;
  const bool in_one_leaf =
      (base.x() & kLast) != kLast && (base.y() & kLast) != kLast && (base.z() & kLast) != kLast;
  const Leaf* const leaf = in_one_leaf ? accessor.probeConstLeaf(base) : nullptr;
  if (leaf != nullptr) {
    const openvdb::Index first = Leaf::coordToOffset(base);
    for (openvdb::Index n = 0; n < 8; ++n) {
      const openvdb::Index at = first + ((n >> 2) << 6) + (((n >> 1) & 1) << 3) + (n & 1);
      cell.values[n] = leaf->getValue(at);
      cell.active |= (leaf->isValueOn(at) ? 1U : 0U) << n;
    }
    return cell;
  }
  for (unsigned n = 0; n < 8; ++n) {
    const Coord at = base.offsetBy(static_cast<int>(n >> 2), static_cast<int>((n >> 1) & 1),
                                   static_cast<int>(n & 1));
    cell.active |= (accessor.probeValue(at, cell.values[n]) ? 1U : 0U) << n;
  }
  return cell;
}

/// Trilinear interpolation of the voxels: one continuous function everywhere. Voxels outside the
/// band count as a constant plateau; outside the box of all voxels the value rises with the
/// distance to that box.
class AccessorField final : public Field {
 public:
  explicit AccessorField(LevelSet grid)
      : grid_(std::move(grid)),
        tree_(grid_.impl().grid->tree()),
        origin_(grid_.impl().origin),
        voxel_(grid_.info().voxel_size),
        meters_per_unit_(grid_.info().meters_per_unit),
        plateau_(plateauOf(grid_.info(), Sampler::kAccessor)) {
    const Survey survey = surveyGrid(*grid_.impl().grid, plateau_);
    // The slope of a distance is 1, though a grid whose surface is flat may have less.
    lipschitz_ = std::max(1.0, survey.steepest);
    // A cell has negative values only if one of its corners is negative, and a known voxel only if
    // one of its corners is known.
    if (!survey.inside.empty()) bounds_ = around(survey.inside);
    reach_ = bounds_.unitedWith(survey.known.empty() ? Box3{} : around(survey.known));
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    if (!reach_.contains(p)) return beyond(p);
    const Vec3 q = (p - origin_) / voxel_;
    const Vec3 base = glm::floor(q);
    const Accessor accessor(tree_);
    Cell cell = readCell(accessor, Coord(static_cast<int>(base.x), static_cast<int>(base.y),
                                         static_cast<int>(base.z)));
    constexpr unsigned kAll = 0xFF;
    if (cell.active == kAll) return interpolate(cell.values, q - base);
    for (unsigned n = 0; n < 8; ++n) {
      if ((cell.active >> n & 1U) == 0) cell.values[n] = std::copysign(plateau_, cell.values[n]);
    }
    return {interpolate(cell.values, q - base).value, Vec3(0.0), false};
  }

  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] double featureSize() const noexcept override { return voxel_; }

  [[nodiscard]] const LevelSet& grid() const noexcept { return grid_; }

 private:
  [[nodiscard]] Vec3 position(const Coord& at) const noexcept {
    return origin_ + voxel_ * Vec3(at.x(), at.y(), at.z());
  }

  [[nodiscard]] Box3 around(const CoordBBox& voxels) const noexcept {
    return {position(voxels.min().offsetBy(-1)), position(voxels.max().offsetBy(1))};
  }

  [[nodiscard]] FieldSample interpolate(const std::array<float, 8>& v,
                                        const Vec3& t) const noexcept {
    // Interpolate along z, then y, then x; each step keeps the differences that make the gradient.
    const auto mix = [](double a, double b, double s) { return a + s * (b - a); };
    double along_z[4], dz[4];
    for (std::size_t n = 0; n < 4; ++n) {
      const double lo = v[2 * n], hi = v[2 * n + 1];
      along_z[n] = mix(lo, hi, t.z);
      dz[n] = hi - lo;
    }
    const double near = mix(along_z[0], along_z[1], t.y);
    const double far = mix(along_z[2], along_z[3], t.y);
    const Vec3 slope(far - near, mix(along_z[1] - along_z[0], along_z[3] - along_z[2], t.x),
                     mix(mix(dz[0], dz[1], t.y), mix(dz[2], dz[3], t.y), t.x));
    return {mix(near, far, t.x) * meters_per_unit_, slope * (meters_per_unit_ / voxel_), true};
  }

  /// The sample where no voxel is near; also for p that is not a number.
  [[nodiscard]] FieldSample beyond(const Vec3& p) const noexcept {
    const double plateau = plateau_ * meters_per_unit_;
    if (!isFinite(p)) return {std::numeric_limits<double>::quiet_NaN(), Vec3(0.0), false};
    if (reach_.isEmpty()) return {plateau, Vec3(0.0), false};
    const Vec3 out = glm::max(glm::max(reach_.lo - p, p - reach_.hi), Vec3(0.0));
    // hypot, because squares overflow for far points.
    return {plateau + std::hypot(out.x, out.y, out.z), Vec3(0.0), false};
  }

  LevelSet grid_;
  const Tree& tree_;
  Vec3 origin_;             ///< [m] center of voxel (0, 0, 0)
  double voxel_;            ///< [m]
  double meters_per_unit_;  ///< [m]
  float plateau_;           ///< [units]
  double lipschitz_ = 1.0;
  Box3 bounds_;
  Box3 reach_;  ///< [m] every cell beyond it is unknown and outside
};

/// Bricks of the part of the grid in the box; all of them if nothing lies outside it.
FieldPtr brickField(const LevelSet& grid, Sampler sampler, const Box3& within,
                    std::uint64_t max_memory) {
  const Box3 bounds = grid.info().bounds;
  if (!within.isBounded() || (within.contains(bounds.lo) && within.contains(bounds.hi))) {
    return std::make_shared<BrickField>(grid, sampler, chosenInstructionSet(), Box3::everything(),
                                        max_memory);
  }
  auto part =
      std::make_shared<BrickField>(grid, sampler, chosenInstructionSet(), within, max_memory);
  return knownWithin(std::move(part), within);
}

}  // namespace

FieldPtr gridField(const LevelSet& grid, Sampler sampler, const Box3& within,
                   std::uint64_t max_memory) {
  if (sampler == Sampler::kAccessor) return std::make_shared<AccessorField>(grid);
  const bool is_narrow = sampler == Sampler::kCubic && isTooNarrow(grid.info());
  const LevelSet wide = is_narrow ? widened(grid, kCubicHalfWidth) : grid;
  // The grid stays in memory while bricks are made from it.
  const std::uint64_t limit = memoryLimit(max_memory);
  const std::uint64_t taken = wide.info().memory;
  return brickField(wide, sampler, within, limit > taken ? limit - taken : 1);
}

FieldPtr gridField(const LevelSet& grid, Sampler sampler, const Box3& within) {
  return gridField(grid, sampler, within, 0);
}

std::uint64_t memoryOf(const Field& grid_field) noexcept {
  const Field& field = knownField(grid_field);
  if (const auto* bricks = dynamic_cast<const BrickField*>(&field)) {
    return bricks->bricks().memory();
  }
  const auto* accessor = dynamic_cast<const AccessorField*>(&field);
  return accessor != nullptr ? accessor->grid().info().memory : 0;
}

}  // namespace palpate::vdb
