#include <openvdb/tree/LeafManager.h>
#include <openvdb/tree/ValueAccessor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "grid/vdb_file.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/grid_check.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Accessor = openvdb::tree::ValueAccessor<const Tree, /*IsSafe=*/false>;

const std::array<Coord, 6> kBeside{Coord(1, 0, 0),  Coord(-1, 0, 0), Coord(0, 1, 0),
                                   Coord(0, -1, 0), Coord(0, 0, 1),  Coord(0, 0, -1)};

/// Voxels found wrong in some order, and the first of them.
struct Found {
  std::uint64_t voxels = 0;
  Coord first;
  void add(const Coord& at) {
    if (voxels++ == 0) first = at;
  }
  void add(const Found& later) {
    if (voxels == 0) first = later.first;
    voxels += later.voxels;
  }
};

/// What one leaf, or the whole grid, has.
struct Tally {
  Found not_finite;
  Found sign_breaks;
  Found band_holes;
  std::uint64_t inside_voxels = 0;
  std::uint64_t gradients = 0;
  double sum = 0.0;
  double squares = 0.0;  ///< of the differences to 1
  double worst = 1.0;
  Coord worst_at;
  double inside = 0.0;  ///< [voxels]

  void add(const Tally& other) {
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
  }
};

class LeafCheck {
 public:
  explicit LeafCheck(const openvdb::FloatGrid& grid)
      : grid_(grid), map_(*grid.transform().baseMap()), voxel_(longestStep(grid)) {}

  [[nodiscard]] Tally of(const Leaf& leaf) const {
    Tally tally;
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
            Tally& tally) const {
    if (active) {
      tally.inside_voxels += value < 0.0F ? 1 : 0;
      tally.inside += std::clamp(0.5 - value / voxel_, 0.0, 1.0);
    } else if (value < 0.0F) {
      tally.inside += 1.0;
    }
    std::array<float, 6> beside{};
    // What is active and constant, as some tools leave the inside, is no band.
    const float band = grid_.background();
    bool in_band = active && std::abs(value) < band;
    bool breaks = false;
    for (std::size_t n = 0; n < 6; ++n) {
      const Coord there = at + kBeside[n];
      const bool other_active = accessor.probeValue(there, beside[n]);
      in_band = in_band && other_active && std::abs(beside[n]) < band;
      if (active && other_active) continue;
      // Told at the negative one of the two, unless that is no voxel of a leaf.
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

  void addGradient(const Coord& at, const std::array<float, 6>& beside, Tally& tally) const {
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

/// Negative tiles, which no leaf tells of.
void addTiles(const openvdb::FloatGrid& grid, Tally& tally) {
  const Accessor accessor(grid.tree());
  auto tile = grid.tree().cbeginValueAll();
  tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    if (!(*tile < 0.0F)) continue;
    const openvdb::CoordBBox box = tile.getBoundingBox();
    tally.inside += static_cast<double>(box.volume());
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

Tally tallyOf(const openvdb::FloatGrid& grid) {
  openvdb::tree::LeafManager<const Tree> leaves(grid.tree());
  std::vector<Tally> tallies(leaves.leafCount());
  const LeafCheck check(grid);
  leaves.foreach ([&](const Leaf& leaf, std::size_t n) { tallies[n] = check.of(leaf); });
  Tally all;
  for (const Tally& one : tallies) all.add(one);
  addTiles(grid, all);
  return all;
}

double volumeOf(const openvdb::FloatGrid& grid, const Tally& tally, double metres) {
  const double voxel = std::abs(grid.transform().baseMap()->determinant());
  return tally.inside * voxel * metres * metres * metres;
}

void look(const openvdb::FloatGrid& grid, double metres, GridCheck& check) {
  const Tally tally = tallyOf(grid);
  const auto place = [&](const Coord& at) {
    const openvdb::Vec3d p = grid.indexToWorld(at);
    return metres * Vec3(p.x(), p.y(), p.z());
  };
  const auto defect = [&](const Found& found) {
    return VoxelDefect{found.voxels, found.voxels > 0 ? place(found.first) : Vec3(0.0)};
  };
  check.has_distances = true;
  check.not_finite = defect(tally.not_finite);
  check.sign_breaks = defect(tally.sign_breaks);
  check.band_holes = defect(tally.band_holes);
  check.inside_voxels = tally.inside_voxels;
  check.gradient.voxels = tally.gradients;
  if (tally.gradients > 0) {
    const auto count = static_cast<double>(tally.gradients);
    check.gradient.mean = tally.sum / count;
    check.gradient.deviation = std::sqrt(tally.squares / count);
    check.gradient.worst = tally.worst;
    check.gradient.worst_place = place(tally.worst_at);
  }
  check.volume = volumeOf(grid, tally, metres);
}

bool mayHoldDistances(const openvdb::GridBase& grid) {
  return grid.isType<openvdb::FloatGrid>() && grid.transform().isLinear() &&
         (grid.getGridClass() == openvdb::GRID_LEVEL_SET ||
          grid.getGridClass() == openvdb::GRID_UNKNOWN);
}

}  // namespace

double solidVolume(const LevelSet& grid) {
  const openvdb::FloatGrid& floats = *grid.impl().grid;
  return volumeOf(floats, tallyOf(floats), grid.info().metres_per_unit);
}

std::vector<GridCheck> checkVdb(const std::string& path, const std::string& name,
                                const std::string& unit_if_missing, UnknownClass unknown_class,
                                const Progress& progress) {
  VdbFile file(path);
  const VdbArchive::Entry* only = name.empty() ? nullptr : &file.choose(name);
  std::vector<GridCheck> checks;
  double done = 0.0;
  for (const auto& entry : file.entries()) {
    report(progress, "check grids", done / static_cast<double>(file.entries().size()));
    done += 1.0;
    if (only != nullptr && only != &entry) continue;
    GridCheck check;
    check.grid = file.summaryOf(entry);
    LevelSetInfo& info = check.grid.info;
    if (info.length_unit.empty() && metresPer(unit_if_missing)) {
      info.length_unit = unit_if_missing;
      info.metres_per_unit = *metresPer(unit_if_missing);
      info.voxel_size *= info.metres_per_unit;
      if (!info.bounds.isEmpty()) {
        info.bounds = {info.bounds.lo * info.metres_per_unit,
                       info.bounds.hi * info.metres_per_unit};
      }
    }
    const openvdb::GridBase::Ptr grid = file.read(entry);
    if (mayHoldDistances(*grid)) {
      look(static_cast<const openvdb::FloatGrid&>(*grid), info.metres_per_unit, check);
    }
    try {
      const LevelSet accepted = acceptLevelSet(grid, unit_if_missing, unknown_class, path);
      check.grid.info = accepted.info();
    } catch (const Error& error) {
      check.refused = error.problem();
    }
    if (!entry.has_tree) grid->newTree();  // no two grids' voxels in memory at a time
    checks.push_back(std::move(check));
  }
  report(progress, "check grids", 1.0);
  return checks;
}

}  // namespace palpate::vdb
