#include "bake/implicit_distances.h"

#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bake/band_source.h"
#include "bake/band_tree.h"
#include "bake/closest_point.h"
#include "bake/implicit_feet.h"
#include "bake/wall_leaves.h"
#include "palpate/vdb/text.h"
#include "scan/distance_leaves.h"
#include "scan/leaf_places.h"
#include "scan/spread_feet.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

/// [voxels] Voxels up to this far beyond the band still pass their points on to neighbors: the
/// shortest path of voxels around a hollow may lead through them.
constexpr double kBeyond = 1.0;
/// [voxels] A neighbor's point that is nearer by less than this counts as the same point.
constexpr double kNearer = 2e-3;
constexpr int kLooks = 3;
/// [voxels] A search may end this much farther off than where it began; beyond that it has found
/// another place of the surface.
constexpr double kSamePlace = 2e-3;
/// [voxels] A neighbor's point this near to the one extrapolated from two voxels in a row lies on a
/// smooth surface.
constexpr double kInLine = 1.0;
/// [voxels] Distance of a voxel that nobody asks for: outside every band, so that it passes nothing
/// on to its neighbors.
constexpr double kOutOfReach = 1e6;

class Spreading {
 public:
  Spreading(const Field& field, const ImplicitSurface& surface, const BakeDomain& domain,
            const BakePlan& plan, const Progress& progress)
      : closest_(field, plan.voxel),
        source_(field, domain.box, domain.is_cut, plan.band),
        is_cut_(domain.is_cut),
        plan_(plan),
        progress_(progress),
        sided_(surface.leaves.size()),
        leaves_(pointsOf(surface), plan.half_width + kBeyond),
        feet_(leaves_, plan.half_width + kBeyond) {
    takeSides(surface);
    for (const SurfaceFoot& foot : surface.feet) {
      DistanceLeaf& leaf = leafAt(foot.voxel);
      const std::size_t place = placeIn(foot.voxel);
      feet_.take(leaf, {place, foot.foot, glm::length(foot.foot), testBit(leaf.inside, place)});
    }
  }

  const DistanceLeaves& run() {
    const auto search = [this](std::size_t b, std::size_t place, const Vec3& start,
                               const Coord& step) { return found(b, place, start, step); };
    const int rounds = static_cast<int>(std::ceil(plan_.half_width + kBeyond)) + 2;
    for (int round = 0; round < rounds; ++round) {
      report(progress_, "bake: distances", 0.3 + 0.5 * round / rounds);
      if (!feet_.spread(search)) break;
    }
    for (int look = 0; look < kLooks; ++look) {
      report(progress_, "bake: distances", 0.8 + 0.05 * look);
      if (!feet_.lookAround(search, kNearer)) break;
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

  [[nodiscard]] FoundFoot found(std::size_t b, std::size_t place, const Vec3& start,
                                const Coord& step) const noexcept {
    const DistanceLeaf& leaf = leaves_.all()[b];
    const Around around(leaves_, leaf);
    const bool is_inside = isInside(b, leaf, around, place, step);
    const double wall = source_.boxDistance(leaf.positionOf(place) * plan_.voxel) / plan_.voxel;
    // Leaves also contain voxels that are farther from the box than the band.
    if (wall > plan_.half_width + kBeyond) return {place, start, kOutOfReach, is_inside};
    const double nearest = glm::length(start);
    // Beyond a face that cuts, the value is the distance to the face unless the surface is farther
    // off. A nearer surface point therefore needs no refinement; it is only passed on to neighbors.
    const bool is_walled = is_cut_ && wall > 0.0 && (is_inside || nearest <= wall);
    if (is_walled) return {place, start, nearest, is_inside};
    const Vec3 foot = footOf(leaf, around, place, start, step);
    return {place, foot, glm::length(foot), is_inside};
  }

  /// The closest point of a voxel, searched from a neighbor's, `start`. `step` leads to the
  /// neighbor.
  [[nodiscard]] Vec3 footOf(const DistanceLeaf& leaf, const Around& around, std::size_t place,
                            const Vec3& start, const Coord& step) const noexcept {
    const Vec3 voxel = leaf.positionOf(place);
    const Vec3 p = voxel * plan_.voxel;
    Vec3 guess = start;
    // The points of two voxels in a row extrapolate to the third one's, up to changes of curvature.
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

  /// A voxel that is found for the first time, and whose side was not looked up, takes the side of
  /// the voxel that it was found from.
  [[nodiscard]] bool isInside(std::size_t b, const DistanceLeaf& leaf, const Around& around,
                              std::size_t place, const Coord& step) const noexcept {
    const bool is_found = leaf.distance[place] != DistanceLeaf::kNowhere;
    if (is_found || testBit(sided_[b], place)) return testBit(leaf.inside, place);
    const Around::Voxel from = around.at(placeOf(place) + step);
    return testBit(from.leaf->inside, from.place);
  }

  ClosestPoint closest_;
  BandSource source_;
  bool is_cut_;
  const BakePlan& plan_;
  const Progress& progress_;
  std::vector<VoxelBits> sided_;  ///< by leaf: voxels whose side is known from the field's value
  DistanceLeaves leaves_;
  FootSpread feet_;
};

/// [voxels^2] A layer of half a voxel on each side of the surface has one voxel for each
/// voxel-sized square of surface.
double areaOf(const ImplicitSurface& surface, const BakeDomain& domain,
              const BakePlan& plan) noexcept {
  const auto near = static_cast<double>(std::count_if(
      surface.feet.begin(), surface.feet.end(),
      [](const SurfaceFoot& foot) { return glm::dot(foot.foot, foot.foot) <= 0.25; }));
  if (!domain.is_cut) return near;
  const Vec3 size = domain.box.size() / plan.voxel;
  return near + 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

/// Cubes are looked up by their coordinates, with 21 bits for each.
void requireNear(const openvdb::CoordBBox& range, const BakePlan& plan,
                 const BakeOptions& options) {
  constexpr int kFarthest = (1 << 23) - 64;
  for (int axis = 0; axis < 3; ++axis) {
    if (range.min()[axis] > -kFarthest && range.max()[axis] < kFarthest) continue;
    throw Error(ErrorKind::kOperation,
                {"bake.too_fine",
                 "'" + options.name + "' reaches more than 2^23 voxels of " +
                     inMillimeters(plan.voxel) + " from the origin",
                 "use larger voxels, or move the shape; also check that it has the length unit it "
                 "should"});
  }
}

/// While distances are found, a leaf takes some four times its memory in the grid.
constexpr double kScratch =
    1.0 + static_cast<double>(sizeof(DistanceLeaf)) / (512.0 * sizeof(float));

}  // namespace

openvdb::FloatGrid::Ptr implicitDistances(const Field& field, const BakeDomain& domain,
                                          const BakePlan& plan, const BakeOptions& options,
                                          const Progress& progress) {
  // The surface nearest to a point inside the box may lie outside it.
  const Box3 around = domain.is_cut ? domain.box.grownBy(plan.band) : domain.box;
  requireNear(voxelRange(around, plan, options.name), plan, options);
  const ImplicitSurface surface = findSurface(field, around, plan, options, progress);
  requireMemory(kScratch * areaOf(surface, domain, plan), 1.0, plan);
  Spreading spreading(field, surface, domain, plan, progress);
  const DistanceLeaves& leaves = spreading.run();
  report(progress, "bake: distances", 0.95);
  openvdb::FloatGrid::Ptr grid = emptyGrid(plan, options);
  addLeaves(leaves, field, domain, plan, *grid);
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

}  // namespace palpate::vdb
