#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "palpate/vdb/level_set.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
/// Not registered with its tree: registering takes a lock. The tree never changes.
using Accessor = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;

/// Eight voxels around a point: bit 2 of the index steps along x, bit 1 along y, bit 0 along z.
struct Cell {
  std::array<float, 8> values;
  bool all_active;
};

Cell readCell(const Accessor& accessor, const Coord& base) noexcept {
  Cell cell{};
  constexpr int kLast = static_cast<int>(Leaf::DIM) - 1;
  const bool in_one_leaf =
      (base.x() & kLast) != kLast && (base.y() & kLast) != kLast && (base.z() & kLast) != kLast;
  const Leaf* const leaf = in_one_leaf ? accessor.probeConstLeaf(base) : nullptr;
  bool active = true;
  if (leaf != nullptr) {
    const openvdb::Index first = Leaf::coordToOffset(base);
    for (openvdb::Index n = 0; n < 8; ++n) {
      const openvdb::Index at = first + ((n >> 2) << 6) + (((n >> 1) & 1) << 3) + (n & 1);
      cell.values[n] = leaf->getValue(at);
      active = active && leaf->isValueOn(at);
    }
  } else {
    for (int n = 0; n < 8; ++n) {
      const Coord at = base.offsetBy(n >> 2, (n >> 1) & 1, n & 1);
      active = accessor.probeValue(at, cell.values[static_cast<std::size_t>(n)]) && active;
    }
  }
  cell.all_active = active;
  return cell;
}

/// What has to be known of a grid before it can be a field.
struct Survey {
  CoordBBox inside;     ///< of the voxels with negative values
  double steepest = 0;  ///< largest |gradient| of the interpolant [-]

  void include(const Survey& other) {
    inside.expand(other.inside);
    steepest = std::max(steepest, other.steepest);
  }
};

/// Bound of the interpolant's gradient in a cell: each component is a mean of four edge differences.
double steepestIn(const std::array<float, 8>& v, double voxel) noexcept {
  double sum = 0.0;
  for (std::size_t step : {4U, 2U, 1U}) {
    double largest = 0.0;
    for (std::size_t n = 0; n < 8; ++n) {
      if ((n & step) != 0) continue;
      largest = std::max(largest, std::abs(static_cast<double>(v[n + step]) - v[n]));
    }
    sum += largest * largest;
  }
  return std::sqrt(sum) / voxel;
}

void surveyLeaf(const Leaf& leaf, const Accessor& accessor, double voxel, Survey& survey) {
  for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
    const Coord at = leaf.offsetToGlobalCoord(n);
    if (leaf.getValue(n) < 0.0F) survey.inside.expand(at);
    if (!leaf.isValueOn(n)) continue;
    const Cell cell = readCell(accessor, at);
    if (cell.all_active) {
      survey.steepest = std::max(survey.steepest, steepestIn(cell.values, voxel));
    }
  }
}

Survey surveyGrid(const openvdb::FloatGrid& grid) {
  const double voxel = grid.voxelSize().x();
  tbb::enumerable_thread_specific<Survey> parts;
  openvdb::tree::LeafManager<const Tree> leaves(grid.tree());
  leaves.foreach ([&](const Leaf& leaf, std::size_t) {
    surveyLeaf(leaf, Accessor(grid.tree()), voxel, parts.local());
  });
  Survey all;
  for (const Survey& part : parts) all.include(part);
  auto tiles = grid.tree().cbeginValueAll();
  tiles.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tiles; ++tiles) {
    if (*tiles < 0.0F) all.inside.expand(tiles.getBoundingBox());
  }
  return all;
}

/// Trilinear interpolation of the voxels. Its zero set is what is felt, and its value is no distance
/// but nearly so: kImplicit.
class GridField final : public Field {
 public:
  explicit GridField(LevelSet grid)
      : grid_(std::move(grid)),
        tree_(grid_.impl().grid->tree()),
        origin_(grid_.impl().origin),
        voxel_(grid_.info().voxel_size),
        metres_per_unit_(grid_.info().metres_per_unit) {
    const Survey survey = surveyGrid(*grid_.impl().grid);
    // Never below 1, the slope of a distance, though a grid whose band is flat measures less.
    lipschitz_ = std::max(1.0, survey.steepest);
    if (!survey.inside.empty()) {
      // A cell's values can be negative only if one of its corners is.
      bounds_.include(position(survey.inside.min().offsetBy(-1)));
      bounds_.include(position(survey.inside.max().offsetBy(1)));
    }
    reach_ = bounds_.grownBy((grid_.info().half_width + 2.0) * voxel_);
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    if (!reach_.contains(p)) return beyond(p);
    const Vec3 q = (p - origin_) / voxel_;
    const Vec3 base = glm::floor(q);
    const Vec3 t = q - base;
    const Accessor accessor(tree_);
    const Cell cell = readCell(accessor, Coord(static_cast<int>(base.x), static_cast<int>(base.y),
                                               static_cast<int>(base.z)));
    return cell.all_active ? interpolate(cell.values, t) : outOfBand(cell.values, t, p);
  }

  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] double featureSize() const noexcept override { return voxel_; }

 private:
  [[nodiscard]] Vec3 position(const Coord& at) const noexcept {
    return origin_ + voxel_ * Vec3(at.x(), at.y(), at.z());
  }

  [[nodiscard]] FieldSample interpolate(const std::array<float, 8>& v,
                                        const Vec3& t) const noexcept {
    // Along z, then y, then x; each step keeps the differences that make the gradient.
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
    return {mix(near, far, t.x) * metres_per_unit_, slope * (metres_per_unit_ / voxel_), true};
  }

  /// Not all of the eight voxels are known. The distance at p is at least that at a corner less the way
  /// there; the slope of the interpolant may be above 1, so its own zero may lie nearer by that.
  [[nodiscard]] FieldSample outOfBand(const std::array<float, 8>& v, const Vec3& t,
                                      const Vec3& p) const noexcept {
    double nearest = -kInfinity;
    for (std::size_t n = 0; n < 8; ++n) {
      const Vec3 corner(static_cast<double>(n >> 2), static_cast<double>((n >> 1) & 1),
                        static_cast<double>(n & 1));
      nearest = std::max(nearest, std::abs(static_cast<double>(v[n])) * metres_per_unit_ -
                                      voxel_ * glm::length(t - corner));
    }
    const double interpolated = interpolate(v, t).value;
    const bool is_inside = std::signbit(interpolated);
    double distance = std::max(std::min(std::abs(interpolated), nearest), 0.0) / lipschitz_;
    if (!is_inside) distance = std::max(distance, bounds_.distanceTo(p));
    return {is_inside ? -distance : distance, Vec3(0.0), false};
  }

  /// So far away that no voxel is near; also where p is not a number.
  [[nodiscard]] FieldSample beyond(const Vec3& p) const noexcept {
    if (!isFinite(p)) return {std::numeric_limits<double>::quiet_NaN(), Vec3(0.0), false};
    if (bounds_.isEmpty()) return {grid_.info().half_width * voxel_, Vec3(0.0), false};
    return {bounds_.distanceTo(p), Vec3(0.0), false};
  }

  LevelSet grid_;
  const Tree& tree_;
  Vec3 origin_;             ///< [m] centre of voxel (0, 0, 0)
  double voxel_;            ///< [m]
  double metres_per_unit_;  ///< [m]
  double lipschitz_ = 1.0;
  Box3 bounds_;
  Box3 reach_;  ///< [m] beyond it there is no voxel to read
};

}  // namespace

FieldPtr gridField(const LevelSet& grid) { return std::make_shared<GridField>(grid); }

}  // namespace palpate::vdb
