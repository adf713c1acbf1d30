#include "brick/voxel_feet.h"

#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Values = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;

/// Least |gradient| of a voxel relative to the mean. Between two faces that meet at a right angle
/// it is 0.7.
constexpr double kLeastSlope = 0.9;
/// Slopes are summed as integers, in millionths, so that the order of threads does not matter.
constexpr double kPerSlope = 1e6;

/// [voxels per voxel] Gradient by central differences; 0 at the rim.
Vec3 gradientAt(const Values& values, const Coord& at, double units_per_voxel) {
  Vec3 gradient(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    Coord ahead = at, behind = at;
    ++ahead[axis];
    --behind[axis];
    float after = 0.0F, before = 0.0F;
    if (!values.probeValue(ahead, after) || !values.probeValue(behind, before)) return Vec3(0.0);
    gradient[axis] = (static_cast<double>(after) - before) / (2.0 * units_per_voxel);
  }
  return gradient;
}

double meanSlope(openvdb::tree::LeafManager<const Tree>& leaves, double units_per_voxel) {
  std::atomic<std::uint64_t> sum = 0;
  std::atomic<std::uint64_t> count = 0;
  leaves.foreach ([&](const Leaf& leaf, std::size_t) {
    const Values values(leaves.tree());
    std::uint64_t slopes = 0;
    std::uint64_t voxels = 0;
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      const double slope = glm::length(gradientAt(values, voxel.getCoord(), units_per_voxel));
      if (!(slope > 0.0)) continue;
      slopes += static_cast<std::uint64_t>(std::min(slope, 2.0) * kPerSlope);
      ++voxels;
    }
    sum += slopes;
    count += voxels;
  });
  if (count == 0) return 1.0;
  return static_cast<double>(sum.load()) / kPerSlope / static_cast<double>(count.load());
}

}  // namespace

void findVoxelFeet(const Tree& tree, double units_per_voxel, Offsets& offsets) {
  openvdb::tree::LeafManager<const Tree> leaves(tree);
  // If values are scaled, as by a wrong unit, slopes are smaller everywhere.
  const double least = kLeastSlope * std::min(1.0, meanSlope(leaves, units_per_voxel));
  leaves.foreach ([&](const Leaf& leaf, std::size_t) {
    Offsets::LeafNodeType* const to = offsets.probeLeaf(leaf.origin());
    if (to == nullptr) return;
    const Values values(tree);
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      const Vec3 gradient = gradientAt(values, voxel.getCoord(), units_per_voxel);
      const double slope = glm::length(gradient);
      const Vec3 foot =
          slope > least ? -gradient * (*voxel / (units_per_voxel * slope)) : Vec3(kNoFoot);
      to->setValueOnly(voxel.pos(), toVdb(foot));
    }
  });
}

}  // namespace palpate::vdb
