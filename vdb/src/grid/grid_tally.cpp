#include "grid/grid_tally.h"

#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Accessor = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;

const std::array<Coord, 6> kBeside{Coord(1, 0, 0),  Coord(-1, 0, 0), Coord(0, 1, 0),
                                   Coord(0, -1, 0), Coord(0, 0, 1),  Coord(0, 0, -1)};

class LeafCheck {
 public:
  explicit LeafCheck(const openvdb::FloatGrid& grid)
      : grid_(grid), map_(*grid.transform().baseMap()), voxel_(longestStep(grid)) {}

  [[nodiscard]] GridTally of(const Leaf& leaf) const {
    GridTally tally;
    const Accessor accessor(grid_.tree());
    for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
      const float value = leaf.getValue(n);
      const Coord at = leaf.offsetToGlobalCoord(n);
      if (!std::isfinite(value)) {
        tally.not_finite.add(at);
        continue;
      }
      look(accessor, at, value, leaf.isValueOn(n), tally);
    }
    return tally;
  }

 private:
  static double longestStep(const openvdb::FloatGrid& grid) {
    const openvdb::Vec3d size = grid.voxelSize();
    return std::max({size.x(), size.y(), size.z()});
  }

  void look(const Accessor& accessor, const Coord& at, float value, bool active,
            GridTally& tally) const {
    if (active) {
      tally.inside_voxels += value < 0.0F ? 1 : 0;
      tally.inside += std::clamp(0.5 - value / voxel_, 0.0, 1.0);
    } else if (value < 0.0F) {
      tally.inside += 1.0;
      tally.marked_inside += 1.0;
    }
    std::array<float, 6> beside{};
    // Active voxels of constant value, with which some tools fill the inside, are not part of the
    // band.
    const float band = grid_.background();
    bool in_band = active && std::abs(value) < band;
    bool breaks = false;
    for (std::size_t n = 0; n < 6; ++n) {
      const Coord there = at + kBeside[n];
      const bool other_active = accessor.probeValue(there, beside[n]);
      in_band = in_band && other_active && std::abs(beside[n]) < band;
      if (active && other_active) continue;
      // A break is counted at the negative voxel of the two, unless that voxel is not in a leaf.
      const bool is_break = (value < 0.0F) != (beside[n] < 0.0F);
      breaks = breaks || (is_break && (value < 0.0F || accessor.probeConstLeaf(there) == nullptr));
    }
    if (breaks) tally.sign_breaks.add(at);
    if (in_band) return addGradient(at, beside, tally);
    if (!active) return;
    const bool deep = std::abs(value) + 1.5 * voxel_ < grid_.background();
    const bool ends = std::any_of(kBeside.begin(), kBeside.end(), [&](const Coord& step) {
      return !accessor.isValueOn(at + step);
    });
    if (deep && ends) tally.band_holes.add(at);
  }

  void addGradient(const Coord& at, const std::array<float, 6>& beside, GridTally& tally) const {
    const openvdb::Vec3d slope(0.5 * (static_cast<double>(beside[0]) - beside[1]),
                               0.5 * (static_cast<double>(beside[2]) - beside[3]),
                               0.5 * (static_cast<double>(beside[4]) - beside[5]));
    const double length = map_.applyIJT(slope, at.asVec3d()).length();
    ++tally.gradients;
    tally.sum += length;
    tally.squares += (length - 1.0) * (length - 1.0);
    if (std::abs(length - 1.0) > std::abs(tally.worst - 1.0)) {
      tally.worst = length;
      tally.worst_at = at;
    }
  }

  const openvdb::FloatGrid& grid_;
  const openvdb::math::MapBase& map_;
  double voxel_;
};

/// Adds negative tiles, which no leaf counts.
void addTiles(const openvdb::FloatGrid& grid, GridTally& tally) {
  const Accessor accessor(grid.tree());
  auto tile = grid.tree().cbeginValueAll();
  tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    if (!(*tile < 0.0F)) continue;
    const openvdb::CoordBBox box = tile.getBoundingBox();
    tally.inside += static_cast<double>(box.volume());
    if (!tile.isValueOn()) tally.marked_inside += static_cast<double>(box.volume());
    const int step = static_cast<int>(Leaf::DIM);
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      for (int side = 0; side < 2; ++side) {
        Coord at = side == 0 ? box.min() : box.max();
        Coord out = at;
        out[axis] += side == 0 ? -1 : 1;
        for (at[u] = box.min()[u]; at[u] <= box.max()[u]; at[u] += step) {
          for (at[v] = box.min()[v]; at[v] <= box.max()[v]; at[v] += step) {
            out[u] = at[u];
            out[v] = at[v];
            if (accessor.probeConstLeaf(out) == nullptr && accessor.getValue(out) >= 0.0F) {
              tally.sign_breaks.add(at);
            }
          }
        }
      }
    }
  }
}

}  // namespace

void GridTally::add(const GridTally& other) {
  not_finite.add(other.not_finite);
  sign_breaks.add(other.sign_breaks);
  band_holes.add(other.band_holes);
  inside_voxels += other.inside_voxels;
  gradients += other.gradients;
  sum += other.sum;
  squares += other.squares;
  if (std::abs(other.worst - 1.0) > std::abs(worst - 1.0)) {
    worst = other.worst;
    worst_at = other.worst_at;
  }
  inside += other.inside;
  marked_inside += other.marked_inside;
}

GridTally tallyOf(const openvdb::FloatGrid& grid) {
  openvdb::tree::LeafManager<const Tree> leaves(grid.tree());
  std::vector<GridTally> tallies(leaves.leafCount());
  const LeafCheck check(grid);
  leaves.foreach ([&](const Leaf& leaf, std::size_t n) { tallies[n] = check.of(leaf); });
  GridTally all;
  for (const GridTally& one : tallies) all.add(one);
  addTiles(grid, all);
  return all;
}

}  // namespace palpate::vdb
