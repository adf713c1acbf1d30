#include "grid/voxel_steps.h"

#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Accessor = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;

constexpr int kSide = 10;  ///< a leaf and one more voxel on every side
/// [voxels] By how much the band of a grid from another tool may be narrower than it states.
constexpr double kRim = 0.25;

/// The voxels around a leaf; inactive ones are NaN.
struct Block {
  std::array<float, static_cast<std::size_t>(kSide) * kSide * kSide> values;

  static std::size_t at(int x, int y, int z) noexcept {
    return static_cast<std::size_t>(((x + 1) * kSide + y + 1) * kSide + z + 1);
  }
};

void gather(const Leaf& leaf, const Accessor& accessor, double scale, Block& block) {
  for (int x = -1; x < 9; ++x) {
    for (int y = -1; y < 9; ++y) {
      for (int z = -1; z < 9; ++z) {
        const Coord at = leaf.origin().offsetBy(x, y, z);
        const bool is_own = ((x | y | z) & ~7) == 0;
        float value = 0.0F;
        const bool active = is_own ? leaf.probeValue(at, value) : accessor.probeValue(at, value);
        block.values[Block::at(x, y, z)] =
            active ? static_cast<float>(value * scale) : std::nanf("");
      }
    }
  }
}

struct Step {
  std::ptrdiff_t by;
  double length;
};

const std::array<Step, 26>& steps() {
  static const std::array<Step, 26> all = [] {
    std::array<Step, 26> list{};
    std::size_t n = 0;
    for (int i = 0; i < 27; ++i) {
      if (i == 13) continue;
      const int x = i / 9 - 1;
      const int y = i / 3 % 3 - 1;
      const int z = i % 3 - 1;
      list[n++] = {(x * kSide + y) * kSide + z, std::sqrt(x * x + y * y + z * z)};
    }
    return list;
  }();
  return all;
}

void raise(VoxelSteps::Worst& worst, double by, const Coord& at) {
  if (by > worst.by) worst = {by, at};
}

void look(const Leaf& leaf, const Block& block, double half_width, VoxelSteps& found) {
  for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
    const Coord local = Leaf::offsetToLocalCoord(n);
    const std::size_t at = Block::at(local.x(), local.y(), local.z());
    const double here = static_cast<double>(block.values[at]);
    if (std::isnan(here)) continue;
    const double size = std::fabs(here);
    double worst = 0.0;
    bool is_near = size < kBesideSurface;
    bool has_hole = false;
    for (const Step& step : steps()) {
      const double there = static_cast<double>(
          block.values[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + step.by)]);
      if (std::isnan(there)) {
        has_hole = has_hole || size + step.length < half_width - kRim;
        continue;
      }
      const double more = std::fabs(there - here) - step.length;
      if (more > worst) {
        worst = more;
        is_near = is_near || std::fabs(there) < kBesideSurface;
      }
    }
    const Coord global = leaf.origin() + local;
    raise(is_near ? found.near : found.far, worst, global);
    if (!has_hole) continue;
    VoxelSteps::Holes& holes = size < kBesideSurface ? found.near_holes : found.far_holes;
    if (holes.voxels++ == 0) holes.at = global;
  }
}

void add(VoxelSteps::Holes& to, const VoxelSteps::Holes& from) {
  if (to.voxels == 0) to.at = from.at;
  to.voxels += from.voxels;
}

}  // namespace

VoxelSteps stepsOf(const LevelSet& grid) {
  const Tree& tree = grid.impl().grid->tree();
  const LevelSetInfo& info = grid.info();
  const double scale = info.meters_per_unit / info.voxel_size;
  openvdb::tree::LeafManager<const Tree> leaves(tree);
  std::vector<VoxelSteps> found(leaves.leafCount());
  leaves.foreach ([&](const Leaf& leaf, std::size_t n) {
    Block block;
    gather(leaf, Accessor(tree), scale, block);
    look(leaf, block, info.half_width, found[n]);
  });
  VoxelSteps all;
  for (const VoxelSteps& one : found) {
    raise(all.near, one.near.by, one.near.at);
    raise(all.far, one.far.by, one.far.at);
    add(all.near_holes, one.near_holes);
    add(all.far_holes, one.far_holes);
  }
  return all;
}

}  // namespace palpate::vdb
