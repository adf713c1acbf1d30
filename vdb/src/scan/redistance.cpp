#include "scan/redistance.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bake/bake_plan.h"
#include "palpate/vdb/openvdb_access.h"
#include "scan/crossings.h"
#include "scan/distance_grid.h"
#include "scan/distance_leaves.h"
#include "scan/for_blocks.h"
#include "scan/spread_feet.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

constexpr std::size_t kVoxels = DistanceLeaf::kVoxels;
/// [voxels] Voxels up to this far beyond the band still pass their points on to neighbors: the
/// shortest path of voxels around a hollow may lead through them.
constexpr double kBeyond = 1.0;
/// [voxels] A neighbor's point that is nearer by less than this counts as the same point.
constexpr double kNearer = 1e-3;
/// [lattice diagonals] How much farther off a closest point may be than the start of its search, a
/// crossing by linear interpolation; a point farther than that belongs to another place.
constexpr double kSamePlace = 0.3;
/// [lattice diagonals] From this distance on the nearest lattice point is on a voxel's own side.
constexpr double kClear = 0.5;
/// The spline's value must be at least this share of the distance; otherwise it belongs to another
/// part of the surface.
constexpr double kAlike = 0.5;

class Redistance {
 public:
  Redistance(const LatticeSpline& spline, const Band& band, const Mask& mask, const Image& image,
             const Vec3& phase, const BakeOptions& options, const Progress& progress)
      : spline_(spline),
        mask_(mask),
        axes_(image.axes),
        origin_(image.origin - phase),
        progress_(progress),
        plan_(checkOptions(options)),
        to_index_(glm::inverse(image.axes)),
        diagonal_(glm::length(glm::abs(image.axes[0]) + glm::abs(image.axes[1]) +
                              glm::abs(image.axes[2]))),
        step_(std::min(
            {glm::length(image.axes[0]), glm::length(image.axes[1]), glm::length(image.axes[2])})),
        crossings_(crossingsOf(band, options)),
        // The surface near a crossing reaches up to a lattice step from it.
        leaves_(crossings_, plan_.half_width + kBeyond + diagonal_ / plan_.voxel),
        feet_(leaves_, plan_.half_width + kBeyond) {}

  const DistanceLeaves& run() {
    seed();
    const auto search = [this](std::size_t b, std::size_t place, const Vec3& start, const Coord&) {
      return found(leaves_.all()[b], place, start);
    };
    const int rounds = static_cast<int>(std::ceil(plan_.half_width + kBeyond)) + 2;
    for (int round = 0; round < rounds; ++round) {
      report(progress_, "distances", 0.1 + 0.7 * round / rounds);
      if (!feet_.spread(search)) break;
    }
    // A speck between lattice points, which is found late, must spread through the whole band as
    // well: spreading halfway would contradict the other distances.
    for (int look = 0; look < rounds; ++look) {
      report(progress_, "distances", 0.8 + 0.2 * look / rounds);
      if (!feet_.lookAround(search, kNearer)) break;
    }
    return leaves_;
  }

  [[nodiscard]] const BakePlan& plan() const noexcept { return plan_; }

 private:
  /// [voxels] Crossings by linear interpolation; at the image's border half-way to the voxel beyond
  /// it.
  [[nodiscard]] std::vector<Vec3> crossingsOf(const Band& band, const BakeOptions& options) const {
    report(progress_, "distances", 0.0);
    std::vector<Vec3> crossings;
    Box3 bounds;
    for (const BandBlock& block : band.blocks) {
      forCrossings(
          band, mask_, block,
          [&](const std::array<int, 3>& at, int axis, int side, float in, float out) {
            const double share = std::isnan(out) ? 0.5 : static_cast<double>(in / (in - out));
            Vec3 index(mask_.first[0] + at[0], mask_.first[1] + at[1], mask_.first[2] + at[2]);
            index[axis] += side * share;
            const Vec3 p = axes_ * index + origin_;
            bounds.include(p);
            crossings.push_back(p / plan_.voxel);
          });
    }
    (void)voxelRange(bounds, plan_, options.name);
    // On the mean, each crossed lattice edge stands for two thirds of a voxel's face of surface.
    const double face = std::pow(std::abs(glm::determinant(axes_)), 2.0 / 3.0);
    const double area =
        static_cast<double>(crossings.size()) * face / (1.5 * plan_.voxel * plan_.voxel);
    constexpr double kRough = 4.0;
    requireMemory(area, kRough, plan_);
    return crossings;
  }

  /// Each voxel around crossings starts from the nearest one.
  void seed() {
    for (const Vec3& p : crossings_) {
      const Vec3 low = glm::floor(p);
      for (int n = 0; n < 8; ++n) {
        const Vec3 corner = low + Vec3(n >> 2, n >> 1 & 1, n & 1);
        const Coord at(static_cast<int>(corner.x), static_cast<int>(corner.y),
                       static_cast<int>(corner.z));
        DistanceLeaf& leaf = leaves_.all()[static_cast<std::size_t>(leaves_.indexAt(at))];
        const Vec3 foot = p - corner;
        const int place = ((at.x() & 7) << 6) | ((at.y() & 7) << 3) | (at.z() & 7);
        const auto distance = static_cast<float>(glm::length(foot));
        float& least = leaf.distance[static_cast<std::size_t>(place)];
        if (distance >= least) continue;
        least = distance;
        leaf.feet.set(static_cast<std::size_t>(place), foot);
      }
    }
    forBlocks(leaves_.all().size(), [&](std::size_t b) {
      DistanceLeaf& leaf = leaves_.all()[b];
      for (std::size_t n = 0; n < kVoxels; ++n) {
        if (leaf.feet.has(n)) feet_.take(leaf, found(leaf, n, leaf.feet.at(n)));
      }
    });
  }

  /// Searches the closest point of a voxel, from `start` [voxels from it].
  [[nodiscard]] FoundFoot found(const DistanceLeaf& leaf, std::size_t place,
                                const Vec3& start) const noexcept {
    const Vec3 p = leaf.positionOf(place) * plan_.voxel;
    FoundFoot result{place, start, glm::length(start), false};
    const auto foot = spline_.foot(p, p + start * plan_.voxel);
    const bool holds =
        foot && std::abs(foot->distance) < result.distance * plan_.voxel + kSamePlace * diagonal_;
    if (holds) {
      result.foot = (foot->point - p) / plan_.voxel;
      result.distance = std::abs(foot->distance) / plan_.voxel;
    }
    const bool by_foot = holds && foot->distance < 0.0;
    if (holds && result.distance * plan_.voxel < kClear * diagonal_) {
      result.inside = by_foot;
    } else {
      // Smoothing rounds off corners of the mask. There the spline decides the side, if its value
      // and the distance to the point agree.
      const bool by_mask = latticeInside(p);
      const double value = spline_.valueAt(indexOf(p)).value_or(0.0) * step_;
      const bool agrees = holds && (value < 0.0) == by_foot &&
                          std::abs(value) > kAlike * result.distance * plan_.voxel;
      result.inside = agrees ? by_foot : by_mask;
    }
    return result;
  }

  /// Converts to indices of the band's box.
  [[nodiscard]] Vec3 indexOf(const Vec3& p) const noexcept {
    return to_index_ * (p - origin_) - Vec3(mask_.first[0], mask_.first[1], mask_.first[2]);
  }

  [[nodiscard]] bool latticeInside(const Vec3& p) const noexcept {
    const Vec3 index = glm::round(indexOf(p));
    std::array<int, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double place = index[axis];
      if (!(place >= 0.0 && place < mask_.box[a])) return false;
      at[a] = static_cast<int>(place);
    }
    return mask_.inside[static_cast<std::size_t>(mask_.at(at[0], at[1], at[2]))] != 0;
  }

  const LatticeSpline& spline_;
  const Mask& mask_;
  Mat3 axes_;
  Vec3 origin_;  ///< [m] of the image's first voxel, from the grid's voxel (0, 0, 0)
  const Progress& progress_;
  BakePlan plan_;
  Mat3 to_index_;
  double diagonal_;              ///< [m] diagonal of a lattice cell
  double step_;                  ///< [m] unit of the spline's values
  std::vector<Vec3> crossings_;  ///< [voxels]
  DistanceLeaves leaves_;
  FootSpread feet_;
};

}  // namespace

LevelSet bakeSpline(const LatticeSpline& spline, const Band& band, const Mask& mask,
                    const Image& image, const BakeOptions& options, const Progress& progress,
                    const Vec3& phase,
                    const std::function<void(const openvdb::FloatGrid::Ptr&)>& last) {
  Redistance redistance(spline, band, mask, image, phase, options, progress);
  const DistanceLeaves& leaves = redistance.run();
  const BakePlan& plan = redistance.plan();
  const openvdb::FloatGrid::Ptr grid = gridOf(leaves, plan, options);
  fitToSpline(grid, leaves, plan, options);
  if (last) last(grid);
  const Vec3 units = phase / plan.meters_per_unit;
  grid->transform().postTranslate(openvdb::Vec3d(units.x, units.y, units.z));
  report(progress, "distances", 1.0);
  return finishGrid(grid, plan, options);
}

}  // namespace palpate::vdb
