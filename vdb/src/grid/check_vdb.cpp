#include <cmath>
#include <utility>
#include <vector>

#include "grid/grid_tally.h"
#include "grid/vdb_file.h"
#include "grid/vdb_walk.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/grid_check.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

double volumeOf(const openvdb::FloatGrid& grid, const GridTally& tally, double meters) {
  const double voxel = std::abs(grid.transform().baseMap()->determinant());
  return tally.inside * voxel * meters * meters * meters;
}

void look(const openvdb::FloatGrid& grid, double meters, GridCheck& check) {
  const GridTally tally = tallyOf(grid);
  const auto place = [&](const Coord& at) {
    const openvdb::Vec3d p = grid.indexToWorld(at);
    return meters * Vec3(p.x(), p.y(), p.z());
  };
  const auto defect = [&](const FoundVoxels& found) {
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
  check.volume = volumeOf(grid, tally, meters);
}

/// Certifies the grid as a scene does before the grid is touched.
void certify(const LevelSet& grid, const std::string& path, const Progress& progress,
             GridCheck& check) {
  CertifyOptions options;
  options.path = path;
  try {
    CertifiedGrid sure = certified(grid, options, progress);
    check.certificate = std::move(sure.certificate);
    check.repairs = std::move(sure.notes);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInput) throw;
    check.uncertified = error.problem();
  }
}

bool mayHoldDistances(const openvdb::GridBase& grid) {
  return grid.isType<openvdb::FloatGrid>() && grid.transform().isLinear() &&
         (grid.getGridClass() == openvdb::GRID_LEVEL_SET ||
          grid.getGridClass() == openvdb::GRID_UNKNOWN);
}

}  // namespace

double solidVolume(const LevelSet& grid) {
  const openvdb::FloatGrid& floats = *grid.impl().grid;
  return volumeOf(floats, tallyOf(floats), grid.info().meters_per_unit);
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
    if (info.length_unit.empty() && metersPer(unit_if_missing)) {
      info.length_unit = unit_if_missing;
      info.meters_per_unit = *metersPer(unit_if_missing);
      info.voxel_size *= info.meters_per_unit;
      if (!info.bounds.isEmpty()) {
        info.bounds = {info.bounds.lo * info.meters_per_unit,
                       info.bounds.hi * info.meters_per_unit};
      }
    }
    // Point grids and the like are refused by their type; their trees are not read.
    const bool is_known = VdbWalk::canWalk(entry.descriptor.gridType());
    const openvdb::GridBase::Ptr grid = is_known ? file.read(entry) : entry.grid;
    if (mayHoldDistances(*grid)) {
      look(static_cast<const openvdb::FloatGrid&>(*grid), info.meters_per_unit, check);
    }
    try {
      const LevelSet accepted = acceptLevelSet(grid, unit_if_missing, unknown_class, path);
      check.grid.info = accepted.info();
      certify(accepted, path, progress, check);
    } catch (const Error& error) {
      check.refused = error.problem();
    }
    if (!entry.has_tree) grid->newTree();  // keeps the voxels of only one grid in memory at a time
    checks.push_back(std::move(check));
  }
  report(progress, "check grids", 1.0);
  return checks;
}

}  // namespace palpate::vdb
