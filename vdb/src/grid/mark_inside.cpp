#include "grid/mark_inside.h"

#include <openvdb/tools/Prune.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <cmath>

#include "grid/grid_tally.h"
#include "palpate/core/error.h"
#include "palpate/vdb/grid_check.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {

std::uint64_t markInside(openvdb::FloatGrid& grid, double meters_per_unit,
                         const std::string& path) {
  const GridTally before = tallyOf(grid);
  if (before.sign_breaks.voxels == 0) return 0;
  // Otherwise leaves and nodes without active voxels would keep their sign, right or wrong.
  grid.tree().voxelizeActiveTiles();
  openvdb::tools::pruneInactive(grid.tree());
  openvdb::tools::signedFloodFill(grid.tree());
  // Signs have now spread from voxel to voxel up to the band. If there is no sign break, each space
  // has one sign, that of the band around it; where the band has a hole, there must be a break.
  const GridTally after = tallyOf(grid);
  if (after.sign_breaks.voxels > 0) {
    const openvdb::Vec3d p = meters_per_unit * grid.indexToWorld(after.sign_breaks.first);
    throw inputError(
        "vdb.torn",
        "the inside of grid '" + grid.getName() +
            "' is not marked and cannot be found: inside and outside meet without a band "
            "in between at " +
            std::to_string(after.sign_breaks.voxels) + " voxels, one at " +
            inMillimeters(Vec3(p.x(), p.y(), p.z())),
        "the band has holes, or the grid was cut off: write it again with a whole band "
        "all around",
        path);
  }
  const double changed = std::abs(after.marked_inside - before.marked_inside);
  return static_cast<std::uint64_t>(std::llround(changed));
}

MarkedInside withInsideMarked(const LevelSet& grid, const std::string& path) {
  const openvdb::FloatGrid& old = *grid.impl().grid;
  if (tallyOf(old).sign_breaks.voxels == 0) return {grid, 0};
  const LevelSetInfo& info = grid.info();
  const openvdb::FloatGrid::Ptr copy = old.deepCopy();
  const std::uint64_t voxels = markInside(*copy, info.meters_per_unit, path);
  return {makeLevelSet(copy, info.length_unit), voxels};
}

}  // namespace palpate::vdb
