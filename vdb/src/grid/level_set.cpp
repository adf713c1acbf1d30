#include "palpate/vdb/level_set.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <mutex>
#include <utility>
#include <vector>

#include "palpate/scene/units.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/version.h"

namespace palpate::vdb {
namespace {

/// OpenVDB's own entries, which LevelSetInfo holds in other members or which a file recomputes.
bool isReserved(const std::string& key) {
  return key == openvdb::GridBase::META_GRID_NAME || key == openvdb::GridBase::META_GRID_CLASS ||
         key == openvdb::GridBase::META_GRID_CREATOR || key == "length_unit" ||
         key == openvdb::GridBase::META_VECTOR_TYPE || key.starts_with("file_");
}

/// The scale [units per voxel] of a transform that only scales uniformly and translates, else 0.
double uniformScale(const openvdb::math::Transform& transform) {
  if (!transform.isLinear()) return 0.0;
  const openvdb::Mat4d m = transform.baseMap()->getAffineMap()->getMat4();
  const double scale = m(0, 0);
  // A product of scales and of rotations by 0 has rounding errors of this size.
  const double tolerance = 1e-9 * scale;
  if (!(scale > 0.0) || !std::isfinite(scale)) return 0.0;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double wanted = row == column ? scale : 0.0;
      if (!(std::abs(m(row, column) - wanted) <= tolerance)) return 0.0;
    }
  }
  return scale;
}

Vec3 fromVdb(const openvdb::Vec3d& v, double meters_per_unit) {
  return Vec3(v.x(), v.y(), v.z()) * meters_per_unit;
}

/// How many voxels are active, and where.
struct Active {
  std::uint64_t voxels = 0;
  openvdb::CoordBBox box;
};

Active activeOf(const openvdb::FloatTree& tree) {
  if (tree.hasActiveTiles()) {
    Active all{tree.activeVoxelCount(), {}};
    tree.evalActiveVoxelBoundingBox(all.box);
    return all;
  }
  // OpenVDB finds this box on one thread only.
  std::vector<const openvdb::FloatTree::LeafNodeType*> leaves;
  tree.getNodes(leaves);
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, leaves.size()), Active{},
      [&](const auto& range, Active all) {
        for (std::size_t n = range.begin(); n != range.end(); ++n) {
          const auto count = leaves[n]->onVoxelCount();
          all.voxels += count;
          if (count > 0) leaves[n]->evalActiveBoundingBox(all.box, /*visitVoxels=*/true);
        }
        return all;
      },
      [](Active a, const Active& b) {
        a.voxels += b.voxels;
        a.box.expand(b.box);
        return a;
      });
}

LevelSetInfo inspect(const openvdb::FloatGrid& grid, const std::string& length_unit,
                     double meters_per_unit, double scale) {
  LevelSetInfo info;
  info.name = grid.getName();
  info.length_unit = length_unit;
  info.meters_per_unit = meters_per_unit;
  info.voxel_size = scale * meters_per_unit;
  // The background is a float: digits of the quotient beyond those of a float mean nothing.
  info.half_width = static_cast<float>(static_cast<double>(grid.background()) / scale);
  const Active active = activeOf(grid.tree());
  info.active_voxels = active.voxels;
  info.memory = grid.memUsage();
  if (info.active_voxels > 0) {
    info.bounds.include(fromVdb(grid.indexToWorld(active.box.min()), meters_per_unit));
    info.bounds.include(fromVdb(grid.indexToWorld(active.box.max()), meters_per_unit));
  }
  for (auto entry = grid.beginMeta(); entry != grid.endMeta(); ++entry) {
    if (isReserved(entry->first) || entry->second->typeName() != "string") continue;
    info.metadata[entry->first] = entry->second->str();
  }
  return info;
}

}  // namespace

void initializeOpenVdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

LevelSet makeLevelSet(openvdb::FloatGrid::Ptr grid, const std::string& length_unit,
                      const std::map<std::string, std::string>& metadata) {
  const std::optional<double> meters = metersPer(length_unit);
  if (!meters) {
    throw inputError("unit.unknown", "unknown length unit '" + length_unit + "'",
                     "use m, cm, mm or um");
  }
  const double scale = uniformScale(grid->transform());
  if (scale == 0.0) {
    throw inputError("vdb.transform",
                     "grid '" + grid->getName() +
                         "' is rotated, mirrored or has voxels that are not cubes; palpate reads "
                         "level sets with cubic, axis-aligned voxels",
                     "palpate convert FILE.vdb -o OTHER.vdb --voxel SIZE makes such a grid of it");
  }
  if (!(grid->background() > 0.0F) || !std::isfinite(grid->background())) {
    throw inputError("vdb.background",
                     "grid '" + grid->getName() + "' has the background value " +
                         std::to_string(grid->background()) +
                         "; a level set has its half width there, which is positive");
  }
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  if (grid->getCreator().empty()) grid->setCreator("palpate");
  grid->insertMeta("length_unit", openvdb::StringMetadata(length_unit));
  if (!(*grid)["palpate:version"]) {
    grid->insertMeta("palpate:version", openvdb::StringMetadata(PALPATE_VERSION_STRING));
  }
  for (const auto& [key, value] : metadata) {
    grid->insertMeta(key, openvdb::StringMetadata(value));
  }
  auto impl = std::make_shared<LevelSet::Impl>();
  impl->info = inspect(*grid, length_unit, *meters, scale);
  impl->origin = fromVdb(grid->indexToWorld(openvdb::Coord(0)), *meters);
  impl->grid = std::move(grid);
  return LevelSet(std::move(impl));
}

const LevelSetInfo& LevelSet::info() const { return impl_->info; }

LevelSet LevelSet::named(std::string name,
                         const std::map<std::string, std::string>& more_metadata) const {
  openvdb::MetaMap all(*impl_->grid);
  auto copy = std::make_shared<Impl>(*impl_);
  for (const auto& [key, value] : more_metadata) {
    all.insertMeta(key, openvdb::StringMetadata(value));
    copy->info.metadata[key] = value;
  }
  all.insertMeta(openvdb::GridBase::META_GRID_NAME, openvdb::StringMetadata(name));
  copy->info.name = std::move(name);
  copy->grid = impl_->grid->copyReplacingMetadata(all);  // the tree stays shared
  return LevelSet(std::move(copy));
}

}  // namespace palpate::vdb
