#include "scan/distance_grid.h"

#include <openvdb/tools/SignedFloodFill.h>

#include <cmath>
#include <memory>
#include <vector>

#include "brick/brick_field.h"
#include "palpate/vdb/openvdb_access.h"
#include "scan/for_blocks.h"

namespace palpate::vdb {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kFits = 2;
constexpr double kFitWidth =
    4.2;  ///< [voxels] least half width of a band that a cubic spline can read at the surface
constexpr double kFitReach = 1.5;  ///< [voxels] from the surface
/// [voxels] A larger error means a part that the voxels do not hold
constexpr double kMostFit = 0.3;
constexpr double kLeastFit = 2e-3;  ///< [voxels] a smaller error is not felt

void fitOnce(const openvdb::FloatGrid::Ptr& grid, const DistanceLeaves& leaves,
             const BakePlan& plan, const BakeOptions& options) {
  const BrickField read(makeLevelSet(grid, options.length_unit), Sampler::kCubic);
  const double units = plan.voxel / plan.meters_per_unit;
  forBlocks(leaves.all().size(), [&](std::size_t b) {
    const DistanceLeaf& from = leaves.all()[b];
    Leaf* const leaf = grid->tree().probeLeaf(from.origin);
    if (leaf == nullptr) return;
    for (std::size_t n = 0; n < DistanceLeaf::kVoxels; ++n) {
      if (!(static_cast<double>(from.distance[n]) < kFitReach)) continue;
      const FieldSample there = read.sample((from.positionOf(n) + from.feet.at(n)) * plan.voxel);
      if (!there.in_band) continue;
      const double off = there.value / plan.voxel;
      if (!(std::abs(off) > kLeastFit && std::abs(off) < kMostFit)) continue;
      const auto place = static_cast<openvdb::Index>(n);
      const float value = leaf->getValue(place) - static_cast<float>(off * units);
      if ((value < 0.0F) == testBit(from.inside, n)) leaf->setValueOnly(place, value);
    }
  });
}

}  // namespace

openvdb::FloatGrid::Ptr gridOf(const DistanceLeaves& leaves, const BakePlan& plan,
                               const BakeOptions& options) {
  openvdb::FloatGrid::Ptr grid = emptyGrid(plan, options);
  const double units = plan.voxel / plan.meters_per_unit;
  std::vector<std::unique_ptr<Leaf>> made(leaves.all().size());
  forBlocks(made.size(), [&](std::size_t b) {
    const DistanceLeaf& from = leaves.all()[b];
    auto leaf = std::make_unique<Leaf>(from.origin, plan.background, false);
    for (std::size_t n = 0; n < DistanceLeaf::kVoxels; ++n) {
      if (from.distance[n] == DistanceLeaf::kNowhere) continue;
      const auto size = static_cast<float>(static_cast<double>(from.distance[n]) * units);
      const float sign = testBit(from.inside, n) ? -1.0F : 1.0F;
      if (size < plan.background) {
        leaf->setValueOn(static_cast<openvdb::Index>(n), sign * size);
      } else {
        leaf->setValueOff(static_cast<openvdb::Index>(n), sign * plan.background);
      }
    }
    if (!leaf->isEmpty()) made[b] = std::move(leaf);
  });
  for (auto& leaf : made) {
    if (leaf) grid->tree().addLeaf(leaf.release());
  }
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

void fitToSpline(const openvdb::FloatGrid::Ptr& grid, const DistanceLeaves& leaves,
                 const BakePlan& plan, const BakeOptions& options) {
  for (int round = 0; round < kFits && plan.half_width > kFitWidth; ++round) {
    fitOnce(grid, leaves, plan, options);
  }
}

}  // namespace palpate::vdb
