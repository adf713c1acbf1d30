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
/// Voxels beyond the band that still tell their neighbors: the nearest way round a hollow leads
/// past them.
constexpr double kBeyond = 1.0;
/// [voxels] A neighbor's point that is nearer by less is the same one.
constexpr double kNearer = 1e-3;
/// [lattice diagonals] By how much a closest point may be further off than where its search began,
/// a crossing by linear interpolation; more is another place's.
constexpr double kSamePlace = 0.3;
/// [lattice diagonals] From there on the nearest lattice point is on a voxel's own side.
constexpr double kClear = 0.5;
/// Of a distance: what the spline has to be at least, to be of the same surface.
constexpr double kAlike = 0.5;

class Redistance {
 public:
  Redistance(const LatticeSpline& spline, const Band& band, const Mask& mask, const Image& image,
             const BakeOptions& options, const Progress& progress)
      : spline_(spline),
        mask_(mask),
        image_(image),
        progress_(progress),
        plan_(checkOptions(options)),
        to_index_(glm::inverse(image.axes)),
        diagonal_(glm::length(glm::abs(image.axes[0]) + glm::abs(image.axes[1]) +
                              glm::abs(image.axes[2]))),
        step_(std::min(
            {glm::length(image.axes[0]), glm::length(image.axes[1]), glm::length(image.axes[2])})),
        crossings_(crossingsOf(band, options)),
        // A crossing's part of the surface reaches up to a lattice step from it.
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
    // What is found late, a speck between lattice points, spreads through the band as well: half of
    // it would contradict the rest.
    for (int look = 0; look < rounds; ++look) {
      report(progress_, "distances", 0.8 + 0.2 * look / rounds);
      if (!feet_.lookAround(search, kNearer)) break;
    }
    return leaves_;
  }

  [[nodiscard]] const BakePlan& plan() const noexcept { return plan_; }

 private:
  /// By linear interpolation, half-way to what lies beyond the image's border [voxels].
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
            const Vec3 p = image_.toWorld(index);
            bounds.include(p);
            crossings.push_back(p / plan_.voxel);
          });
    }
    (void)voxelRange(bounds, plan_, options.name);
    // Each lattice edge crosses some two thirds of a voxel's face of the surface.
    const double face = std::pow(std::abs(glm::determinant(image_.axes)), 2.0 / 3.0);
    const double area =
        static_cast<double>(crossings.size()) * face / (1.5 * plan_.voxel * plan_.voxel);
    constexpr double kRough = 4.0;
    requireMemory(area, kRough, plan_);
    return crossings;
  }

  /// Each voxel around a crossing starts from the nearest one.
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

  /// For the closest point of a voxel, from `start` [voxels from it] on.
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
      // Smoothing rounds corners off that the mask has: there the spline tells, if it and the point
      // agree on how far it is.
      const bool by_mask = latticeInside(p);
      const double value = spline_.valueAt(indexOf(p)).value_or(0.0) * step_;
      const bool agrees = holds && (value < 0.0) == by_foot &&
                          std::abs(value) > kAlike * result.distance * plan_.voxel;
      result.inside = agrees ? by_foot : by_mask;
    }
    return result;
  }

  /// In the band's box.
  [[nodiscard]] Vec3 indexOf(const Vec3& p) const noexcept {
    return to_index_ * (p - image_.origin) - Vec3(mask_.first[0], mask_.first[1], mask_.first[2]);
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
  const Image& image_;
  const Progress& progress_;
  BakePlan plan_;
  Mat3 to_index_;
  double diagonal_;              ///< [m] of a lattice cell
  double step_;                  ///< [m] the spline's unit
  std::vector<Vec3> crossings_;  ///< [voxels]
  DistanceLeaves leaves_;
  FootSpread feet_;
};

}  // namespace

LevelSet bakeSpline(const LatticeSpline& spline, const Band& band, const Mask& mask,
                    const Image& image, const BakeOptions& options, const Progress& progress) {
  Redistance redistance(spline, band, mask, image, options, progress);
  const DistanceLeaves& leaves = redistance.run();
  const BakePlan& plan = redistance.plan();
  const openvdb::FloatGrid::Ptr grid = gridOf(leaves, plan, options);
  fitToSpline(grid, leaves, plan, options);
  report(progress, "distances", 1.0);
  return finishGrid(grid, plan, options);
}

}  // namespace palpate::vdb
