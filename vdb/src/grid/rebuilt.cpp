#include "grid/rebuilt.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cmath>

#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using Tree = openvdb::FloatTree;

/// [voxels] of the band that is kept: what a surface's own voxels tell of each other.
constexpr double kKept = 2.5;

}  // namespace

LevelSet withDistancesRebuilt(const LevelSet& grid, const Progress& progress) {
  const LevelSetInfo& info = grid.info();
  const openvdb::FloatGrid::Ptr copy = grid.impl().grid->deepCopy();
  Tree& tree = copy->tree();
  tree.voxelizeActiveTiles();
  const double kept = std::min(kKept, info.half_width);
  const auto width = static_cast<float>(kept * info.voxel_size / info.metres_per_unit);
  openvdb::tree::LeafManager<Tree> leaves(tree);
  leaves.foreach ([&](Tree::LeafNodeType& leaf, std::size_t) {
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
      if (std::fabs(*voxel) < width) continue;
      voxel.setValue(std::copysign(width, *voxel));
      voxel.setValueOff();
    }
  });
  openvdb::tools::changeLevelSetBackground(tree, width);
  openvdb::tools::pruneLevelSet(tree);
  const LevelSet narrow = makeLevelSet(copy, info.length_unit);
  return widened(narrow, std::max(info.half_width, kCubicHalfWidth), progress);
}

}  // namespace palpate::vdb
