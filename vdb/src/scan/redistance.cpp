#include "scan/redistance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "bake/bake_plan.h"
#include "palpate/vdb/openvdb_access.h"
#include "scan/crossings.h"
#include "scan/distance_grid.h"
#include "scan/distance_leaves.h"
#include "scan/for_blocks.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

constexpr std::size_t kVoxels = DistanceLeaf::kVoxels;
/// Voxels beyond the band that still tell their neighbors: the nearest way round a hollow leads past them.
constexpr double kBeyond = 1.0;
/// [voxels] A neighbor's point that is nearer by less is the same one.
constexpr double kNearer = 1e-3;
/// [lattice diagonals] By how much a closest point may be further off than where its search began, a
/// crossing by linear interpolation; more is another place's.
constexpr double kSamePlace = 0.3;
/// [lattice diagonals] From there on the nearest lattice point is on a voxel's own side.
constexpr double kClear = 0.5;

/// Of a distance: what the spline has to be at least, to be of the same surface.
constexpr double kAlike = 0.5;

/// What is known of a voxel [voxels].
struct Found {
  std::size_t place = 0;
  Vec3 foot{0.0, 0.0, 0.0};
  double distance = 0.0;
  bool inside = false;
};

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
        leaves_(crossings_, plan_.half_width + kBeyond + diagonal_ / plan_.voxel) {}

  const DistanceLeaves& run() {
    seed();
    const int rounds = static_cast<int>(std::ceil(plan_.half_width + kBeyond)) + 2;
    for (int round = 0; round < rounds; ++round) {
      report(progress_, "distances", 0.1 + 0.7 * round / rounds);
      if (!spread()) break;
    }
    // What is found late, a speck between lattice points, spreads through the band as well: half of it would contradict the rest.
    std::vector<std::uint8_t> changed(leaves_.all().size(), 1);
    for (int look = 0; look < rounds; ++look) {
      report(progress_, "distances", 0.8 + 0.2 * look / rounds);
      if (!lookAround(changed)) break;
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

  template <typename Body>
  void forLeaves(const Body& body) {
    forBlocks(leaves_.all().size(), [&](std::size_t n) { body(n, leaves_.all()[n]); });
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
    forLeaves([&](std::size_t, DistanceLeaf& leaf) {
      for (std::size_t n = 0; n < kVoxels; ++n) {
        if (leaf.feet.has(n)) take(leaf, search(leaf, n, leaf.feet.at(n)));
      }
    });
  }

  /// For the closest point of a voxel, from `start` [voxels from it] on.
  [[nodiscard]] Found search(const DistanceLeaf& leaf, std::size_t place,
                             const Vec3& start) const noexcept {
    const Vec3 p = leaf.positionOf(place) * plan_.voxel;
    Found result{place, start, glm::length(start), false};
    const auto found = spline_.foot(p, p + start * plan_.voxel);
    const bool holds =
        found && std::abs(found->distance) < result.distance * plan_.voxel + kSamePlace * diagonal_;
    if (holds) {
      result.foot = (found->point - p) / plan_.voxel;
      result.distance = std::abs(found->distance) / plan_.voxel;
    }
    const bool by_foot = holds && found->distance < 0.0;
    if (holds && result.distance * plan_.voxel < kClear * diagonal_) {
      result.inside = by_foot;
    } else {
      // Smoothing rounds corners off that the mask has: there the spline tells, if it and the point agree on how far it is.
      const bool by_mask = latticeInside(p);
      const double value = spline_.valueAt(indexOf(p)).value_or(0.0) * step_;
      const bool agrees = holds && (value < 0.0) == by_foot &&
                          std::abs(value) > kAlike * result.distance * plan_.voxel;
      result.inside = agrees ? by_foot : by_mask;
    }
    return result;
  }

  /// Neighbors may go on from points within the band, and a little beyond.
  void take(DistanceLeaf& leaf, const Found& found) const noexcept {
    leaf.distance[found.place] = static_cast<float>(found.distance);
    if (found.inside) {
      setBit(leaf.inside, found.place);
    } else {
      clearBit(leaf.inside, found.place);
    }
    if (found.distance < plan_.half_width + kBeyond) {
      leaf.feet.set(found.place, found.foot);
      setBit(leaf.known, found.place);
    } else {
      leaf.feet.set(found.place, Vec3(static_cast<double>(Feet::kNone)));
      clearBit(leaf.known, found.place);
    }
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

  /// One layer of voxels more. False: there is none.
  bool spread() {
    std::vector<std::vector<Found>> fresh(leaves_.all().size());
    forLeaves([&](std::size_t b, const DistanceLeaf& leaf) {
      VoxelBits next = leaves_.besideKnown(leaf);
      std::uint64_t rows = 0;
      for (std::size_t x = 0; x < 8; ++x) {
        next[x] &= ~leaf.known[x];
        for (std::uint64_t rest = next[x]; rest != 0; rest &= rest - 1) {
          const auto n = static_cast<std::size_t>(std::countr_zero(rest));
          if (leaf.distance[64 * x + n] != DistanceLeaf::kNowhere) {
            next[x] &= ~(std::uint64_t{1} << n);  // found, and beyond the band
          } else {
            rows |= std::uint64_t{1} << (8 * x + (n >> 3));
          }
        }
      }
      if (rows == 0) return;
      NearestFeet nearest(Mat3(1.0));
      nearest.find(leaves_.feetAround(leaf), rows);
      for (std::size_t place = 0; place < kVoxels; ++place) {
        if (testBit(next, place)) fresh[b].push_back(search(leaf, place, nearest.foot(place)));
      }
    });
    // When all have searched, so that none sees what others found in the same round.
    forLeaves([&](std::size_t b, DistanceLeaf& leaf) {
      for (const Found& found : fresh[b]) take(leaf, found);
    });
    return std::any_of(fresh.begin(), fresh.end(),
                       [](const auto& found) { return !found.empty(); });
  }

  /// Takes what a neighbor knows better; false if none does. `changed`: leaves that have since all looked last.
  bool lookAround(std::vector<std::uint8_t>& changed) {
    std::vector<std::vector<Found>> better(leaves_.all().size());
    forLeaves([&](std::size_t b, const DistanceLeaf& leaf) {
      if (std::none_of(leaf.near.begin(), leaf.near.end(), [&](std::int32_t n) {
            return n >= 0 && changed[static_cast<std::size_t>(n)] != 0;
          })) {
        return;
      }
      NearestFeet nearest(Mat3(1.0));
      nearest.find(leaves_.feetAround(leaf), ~std::uint64_t{0});
      for (std::size_t place = 0; place < kVoxels; ++place) {
        if (leaf.distance[place] == DistanceLeaf::kNowhere) continue;
        const float enough = leaf.distance[place] - static_cast<float>(kNearer);
        if (enough > 0.0F && nearest.square(place) < enough * enough) {
          const Found found = search(leaf, place, nearest.foot(place));
          if (found.distance < static_cast<double>(enough)) better[b].push_back(found);
        }
      }
    });
    forLeaves([&](std::size_t b, DistanceLeaf& leaf) {
      for (const Found& found : better[b]) take(leaf, found);
      changed[b] = better[b].empty() ? 0 : 1;
    });
    return std::find(changed.begin(), changed.end(), 1) != changed.end();
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
