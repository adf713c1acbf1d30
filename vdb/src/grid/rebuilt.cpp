#include "grid/rebuilt.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <cmath>

#include "grid/voxel_steps.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;
using Mask = openvdb::MaskTree;

/// [voxels] Half width of the band that is kept: a closest point follows from a voxel and all six
/// around it.
constexpr double kKept = 2.5;

/// Voxels whose value cannot be a distance, given that of one of their neighbors; and all voxels
/// next to such a voxel.
Mask doubtful(const Tree& tree, double units_per_voxel) {
  Mask mask(tree, false, false, openvdb::TopologyCopy());
  openvdb::tree::LeafManager<Mask> leaves(mask);
  leaves.foreach ([&](Mask::LeafNodeType& leaf, std::size_t) {
    const openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false> values(tree);
    for (openvdb::Index place = 0; place < Mask::LeafNodeType::SIZE; ++place) {
      const Coord at = leaf.offsetToGlobalCoord(place);
      float here = 0.0F;
      if (!values.probeValue(at, here)) continue;
      for (int n = 0; n < 27; ++n) {
        const Coord step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
        float there = 0.0F;
        if (!values.probeValue(at + step, there)) continue;
        const double way = step.asVec3d().length() + kSmallStep;
        if (std::fabs(static_cast<double>(there) - here) > way * units_per_voxel) {
          leaf.setValueOn(place);
          break;
        }
      }
    }
  });
  openvdb::tools::dilateActiveValues(mask, 1, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                     openvdb::tools::IGNORE_TILES);
  return mask;
}

}  // namespace

LevelSet withDistancesRebuilt(const LevelSet& grid, const Progress& progress) {
  const LevelSetInfo& info = grid.info();
  const openvdb::FloatGrid::Ptr copy = grid.impl().grid->deepCopy();
  Tree& tree = copy->tree();
  tree.voxelizeActiveTiles();
  const double units_per_voxel = info.voxel_size / info.meters_per_unit;
  const auto width = static_cast<float>(std::min(kKept, info.half_width) * units_per_voxel);
  const auto beside = static_cast<float>(kBesideSurface * units_per_voxel);
  const Mask doubts = doubtful(tree, units_per_voxel);
  openvdb::tree::LeafManager<Tree> leaves(tree);
  leaves.foreach ([&](Tree::LeafNodeType& leaf, std::size_t) {
    const openvdb::tree::ValueAccessor<const Mask, /*IsSafe=*/false> doubted(doubts);
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
      const float size = std::fabs(*voxel);
      if (size < beside || (size < width && !doubted.isValueOn(voxel.getCoord()))) continue;
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
