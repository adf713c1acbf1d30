#include "bake/implicit_distances.h"

#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bake/band_source.h"
#include "bake/band_tree.h"
#include "bake/closest_point.h"
#include "bake/implicit_feet.h"
#include "bake/wall_leaves.h"
#include "scan/distance_leaves.h"
#include "scan/for_blocks.h"
#include "scan/leaf_places.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

constexpr std::size_t kVoxels = DistanceLeaf::kVoxels;
/// [voxels] beyond the band that still tell their neighbors: the nearest way round a hollow leads past them.
constexpr double kBeyond = 1.0;
/// [voxels] A neighbor's point that is nearer by less is the same one.
constexpr double kNearer = 2e-3;
constexpr int kLooks = 3;
/// [voxels] A closest point that is further off than the one its search began at by more is another place's.
constexpr double kSamePlace = 2e-3;
/// [voxels] A neighbor's point this near to the one that two in a row lead to is one of a smooth surface.
constexpr double kInLine = 1.0;

/// What is known of a voxel [voxels].
struct Found {
  std::size_t place = 0;
  Vec3 foot{0.0, 0.0, 0.0};
  bool inside = false;
};

class Spreading {
 public:
  Spreading(const Field& field, const ImplicitSurface& surface, const BakePlan& plan,
            const Progress& progress)
      : closest_(field, plan.voxel),
        plan_(plan),
        progress_(progress),
        sided_(surface.leaves.size()),
        leaves_(pointsOf(surface), plan.half_width + kBeyond) {
    grown_.assign(leaves_.all().size(), 1);
    takeSides(surface);
    for (const SurfaceFoot& foot : surface.feet) {
      DistanceLeaf& leaf = leafAt(foot.voxel);
      const std::size_t place = placeIn(foot.voxel);
      take(leaf, {place, foot.foot, testBit(leaf.inside, place)});
    }
  }

  const DistanceLeaves& run() {
    const int rounds = static_cast<int>(std::ceil(plan_.half_width + kBeyond)) + 2;
    for (int round = 0; round < rounds; ++round) {
      report(progress_, "bake: distances", 0.3 + 0.5 * round / rounds);
      if (!spread()) break;
    }
    std::vector<std::uint8_t> changed(leaves_.all().size(), 1);
    for (int look = 0; look < kLooks; ++look) {
      report(progress_, "bake: distances", 0.8 + 0.05 * look);
      lookAround(changed);
    }
    return leaves_;
  }

 private:
  static std::vector<Vec3> pointsOf(const ImplicitSurface& surface) {
    std::vector<Vec3> points;
    points.reserve(surface.feet.size());
    for (const SurfaceFoot& foot : surface.feet) {
      points.push_back(Vec3(foot.voxel.x(), foot.voxel.y(), foot.voxel.z()) + foot.foot);
    }
    return points;
  }

  DistanceLeaf& leafAt(const Coord& voxel) {
    return leaves_.all()[static_cast<std::size_t>(leaves_.indexAt(voxel))];
  }

  void takeSides(const ImplicitSurface& surface) {
    sided_.assign(leaves_.all().size(), {});
    for (const KnownSides& sides : surface.leaves) {
      const std::int32_t index = leaves_.indexAt(sides.origin);
      if (index < 0) continue;
      sided_[static_cast<std::size_t>(index)] = sides.known;
      leaves_.all()[static_cast<std::size_t>(index)].inside = sides.inside;
    }
  }

  template <typename Body>
  void forLeaves(const Body& body) {
    forBlocks(leaves_.all().size(), [&](std::size_t n) { body(n, leaves_.all()[n]); });
  }

  /// Neighbors may go on from points within the band, and a little beyond.
  void take(DistanceLeaf& leaf, const Found& found) const noexcept {
    const double distance = glm::length(found.foot);
    leaf.distance[found.place] = static_cast<float>(distance);
    if (found.inside) {
      setBit(leaf.inside, found.place);
    } else {
      clearBit(leaf.inside, found.place);
    }
    if (distance < plan_.half_width + kBeyond) {
      leaf.feet.set(found.place, found.foot);
      setBit(leaf.known, found.place);
    } else {
      leaf.feet.set(found.place, Vec3(static_cast<double>(Feet::kNone)));
      clearBit(leaf.known, found.place);
    }
  }

  /// For the closest point of a voxel, from that of a neighbor, `start`, on. `step` leads to the neighbor.
  [[nodiscard]] Vec3 search(const DistanceLeaf& leaf, const Around& around, std::size_t place,
                            const Vec3& start, const Coord& step) const noexcept {
    const Vec3 voxel = leaf.positionOf(place);
    const Vec3 p = voxel * plan_.voxel;
    Vec3 guess = start;
    // Two in a row lead on to where the third will be, but for how the surface's bend changes.
    const Coord far = placeOf(place) + Coord(2 * step.x(), 2 * step.y(), 2 * step.z());
    const Around::Voxel second = around.at(far);
    if (second.leaf != nullptr && testBit(second.leaf->known, second.place)) {
      const Vec3 there =
          second.leaf->positionOf(second.place) - voxel + second.leaf->feet.at(second.place);
      const Vec3 on = start - there;
      if (glm::dot(on, on) < kInLine) guess = start + on;
    }
    const auto found = closest_.of(p, p + guess * plan_.voxel);
    const double most = glm::length(start) + kSamePlace;
    if (found) {
      const Vec3 foot = (*found - p) / plan_.voxel;
      if (glm::length(foot) <= most) return foot;
    }
    const Vec3 crept = closest_.creptTo(p, p + start * plan_.voxel);
    return (crept - p) / plan_.voxel;
  }

  /// One layer of voxels more. False: there is none.
  bool spread() {
    std::vector<std::vector<Found>> fresh(leaves_.all().size());
    forLeaves([&](std::size_t b, const DistanceLeaf& leaf) {
      if (!isAnyBeside(leaf, grown_)) return;
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
      const Around around(leaves_, leaf);
      for (std::size_t place = 0; place < kVoxels; ++place) {
        if (!testBit(next, place)) continue;
        const Coord step = stepTo(nearest.which(place));
        fresh[b].push_back({place, search(leaf, around, place, nearest.foot(place), step),
                            isInside(b, leaf, around, place, step)});
      }
    });
    // When all have searched, so that none sees what others found in the same round.
    forLeaves([&](std::size_t b, DistanceLeaf& leaf) {
      for (const Found& found : fresh[b]) take(leaf, found);
      grown_[b] = fresh[b].empty() ? 0 : 1;
    });
    return std::any_of(fresh.begin(), fresh.end(),
                       [](const auto& found) { return !found.empty(); });
  }

  /// Whether the leaf, or one beside it, has a mark.
  static bool isAnyBeside(const DistanceLeaf& leaf, const std::vector<std::uint8_t>& marks) {
    return std::any_of(leaf.near.begin(), leaf.near.end(), [&](std::int32_t n) {
      return n >= 0 && marks[static_cast<std::size_t>(n)] != 0;
    });
  }

  static Coord stepTo(int which) noexcept {
    return {which / 9 - 1, which / 3 % 3 - 1, which % 3 - 1};
  }

  /// What is not looked up has the side of the voxel that it is found from.
  [[nodiscard]] bool isInside(std::size_t b, const DistanceLeaf& leaf, const Around& around,
                              std::size_t place, const Coord& step) const noexcept {
    if (testBit(sided_[b], place)) return testBit(leaf.inside, place);
    const Around::Voxel from = around.at(placeOf(place) + step);
    return testBit(from.leaf->inside, from.place);
  }

  /// Takes what a neighbor knows better. `changed`: leaves that have since all looked last.
  void lookAround(std::vector<std::uint8_t>& changed) {
    std::vector<std::vector<Found>> better(leaves_.all().size());
    forLeaves([&](std::size_t b, const DistanceLeaf& leaf) {
      if (!isAnyBeside(leaf, changed)) return;
      NearestFeet nearest(Mat3(1.0));
      nearest.find(leaves_.feetAround(leaf), ~std::uint64_t{0});
      const Around around(leaves_, leaf);
      for (std::size_t place = 0; place < kVoxels; ++place) {
        if (leaf.distance[place] == DistanceLeaf::kNowhere) continue;
        const float enough = leaf.distance[place] - static_cast<float>(kNearer);
        if (enough > 0.0F && nearest.square(place) < enough * enough) {
          const Coord step = stepTo(nearest.which(place));
          better[b].push_back({place, search(leaf, around, place, nearest.foot(place), step),
                               testBit(leaf.inside, place)});
        }
      }
    });
    forLeaves([&](std::size_t b, DistanceLeaf& leaf) {
      for (const Found& found : better[b]) take(leaf, found);
      changed[b] = better[b].empty() ? 0 : 1;
    });
  }

  ClosestPoint closest_;
  const BakePlan& plan_;
  const Progress& progress_;
  std::vector<VoxelBits> sided_;  ///< by leaf: voxels whose side is known from the field's value
  DistanceLeaves leaves_;
  std::vector<std::uint8_t> grown_;  ///< by leaf: voxels were found in the last round
};

/// [voxels^2] Half a voxel to each side of the surface has one voxel for each voxel's face of it.
double areaOf(const ImplicitSurface& surface, const BakeDomain& domain,
              const BakePlan& plan) noexcept {
  const auto near = static_cast<double>(std::count_if(
      surface.feet.begin(), surface.feet.end(),
      [](const SurfaceFoot& foot) { return glm::dot(foot.foot, foot.foot) <= 0.25; }));
  if (!domain.is_cut) return near;
  const Vec3 size = domain.box.size() / plan.voxel;
  return near + 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

/// Cubes are found by their coordinates in 21 bits each.
void requireNear(const openvdb::CoordBBox& range, const BakePlan& plan,
                 const BakeOptions& options) {
  constexpr int kFarthest = (1 << 23) - 64;
  for (int axis = 0; axis < 3; ++axis) {
    if (range.min()[axis] > -kFarthest && range.max()[axis] < kFarthest) continue;
    throw Error(ErrorKind::kOperation,
                {"bake.too_fine",
                 "'" + options.name + "' reaches more than 2^23 voxels of " +
                     inMillimetres(plan.voxel) + " from the origin",
                 "use larger voxels, or move the shape; also check that it has the length unit it "
                 "should"});
  }
}

/// While distances are found, a leaf takes some four times what it takes in the grid.
constexpr double kScratch =
    1.0 + static_cast<double>(sizeof(DistanceLeaf)) / (512.0 * sizeof(float));

}  // namespace

openvdb::FloatGrid::Ptr implicitDistances(const Field& field, const BakeDomain& domain,
                                          const BakePlan& plan, const BakeOptions& options,
                                          const Progress& progress) {
  // What lies beyond a face that cuts may be the nearest to what lies before it.
  const Box3 around = domain.is_cut ? domain.box.grownBy(plan.band) : domain.box;
  requireNear(voxelRange(around, plan, options.name), plan, options);
  const ImplicitSurface surface = findSurface(field, around, plan, options, progress);
  requireMemory(kScratch * areaOf(surface, domain, plan), 1.0, plan);
  Spreading spreading(field, surface, plan, progress);
  const DistanceLeaves& leaves = spreading.run();
  report(progress, "bake: distances", 0.95);
  openvdb::FloatGrid::Ptr grid = emptyGrid(plan, options);
  addLeaves(leaves, field, domain, plan, *grid);
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

}  // namespace palpate::vdb
