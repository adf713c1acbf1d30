#include "grid/vdb_file.h"

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "palpate/scene/units.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

void openToRead(const std::string& path, StopBuffer& buffer) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw inputError("vdb.missing", "there is no such file", "", path);
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw inputError("vdb.unreadable", "this is not a file", "", path);
  }
  if (buffer.open(path, std::ios::in | std::ios::binary) == nullptr) {
    throw inputError("vdb.unreadable", "the file cannot be opened for reading", "", path);
  }
}

std::string textOf(const openvdb::GridBase& grid, const std::string& key) {
  const openvdb::Metadata::ConstPtr value = grid[key];
  return value ? value->str() : std::string();
}

template <typename Type>
std::optional<Type> valueOf(const openvdb::GridBase& grid, const std::string& key) {
  const auto value = grid.getMetadata<openvdb::TypedMetadata<Type>>(key);
  if (!value) return {};
  return value->value();
}

LevelSetInfo infoOf(const openvdb::GridBase& grid, const std::string& name) {
  LevelSetInfo info;
  info.name = name;
  info.length_unit = textOf(grid, "length_unit");
  info.meters_per_unit = metersPer(info.length_unit).value_or(1.0);
  const double scale = grid.voxelSize().x();
  info.voxel_size = scale * info.meters_per_unit;
  if (const auto* floats = dynamic_cast<const openvdb::FloatGrid*>(&grid)) {
    info.half_width = static_cast<float>(static_cast<double>(floats->background()) / scale);
  }
  const auto count = valueOf<openvdb::Int64>(grid, openvdb::GridBase::META_FILE_VOXEL_COUNT);
  const auto bytes = valueOf<openvdb::Int64>(grid, openvdb::GridBase::META_FILE_MEM_BYTES);
  info.active_voxels = static_cast<std::uint64_t>(count.value_or(0));
  info.memory = static_cast<std::uint64_t>(bytes.value_or(0));
  const auto lo = valueOf<openvdb::Vec3i>(grid, openvdb::GridBase::META_FILE_BBOX_MIN);
  const auto hi = valueOf<openvdb::Vec3i>(grid, openvdb::GridBase::META_FILE_BBOX_MAX);
  if (lo && hi && info.active_voxels > 0) {
    for (const openvdb::Vec3i& corner : {*lo, *hi}) {
      const openvdb::Vec3d p = grid.indexToWorld(openvdb::Vec3d(corner));
      info.bounds.include(Vec3(p.x(), p.y(), p.z()) * info.meters_per_unit);
    }
  }
  for (auto entry = grid.beginMeta(); entry != grid.endMeta(); ++entry) {
    const bool told = entry->first == openvdb::GridBase::META_GRID_NAME ||
                      entry->first == openvdb::GridBase::META_GRID_CLASS ||
                      entry->first == "length_unit" || entry->first.starts_with("file_");
    if (!told) info.metadata[entry->first] = entry->second->str();
  }
  return info;
}

std::string namesOf(const VdbArchive& archive) {
  std::string names;
  for (const auto& entry : archive.entries()) {
    names += (names.empty() ? "'" : ", '") + entry.name() + "'";
  }
  return names.empty() ? "none" : names;
}

}  // namespace

std::string typeOf(const openvdb::GridBase& grid) {
  static const std::map<std::string, std::string> names = [] {
    std::map<std::string, std::string> table;
    table[openvdb::FloatGrid::gridType()] = "FloatGrid";
    table[openvdb::DoubleGrid::gridType()] = "DoubleGrid";
    table[openvdb::Int32Grid::gridType()] = "Int32Grid";
    table[openvdb::Int64Grid::gridType()] = "Int64Grid";
    table[openvdb::BoolGrid::gridType()] = "BoolGrid";
    table[openvdb::MaskGrid::gridType()] = "MaskGrid";
    table[openvdb::Vec3SGrid::gridType()] = "Vec3SGrid";
    table[openvdb::Vec3DGrid::gridType()] = "Vec3DGrid";
    table[openvdb::Vec3IGrid::gridType()] = "Vec3IGrid";
    // By name, because including their headers costs as much again as all others of OpenVDB.
    table["Tree_ptdataidx32_5_4_3"] = "PointDataGrid";
    table["Tree_ptidx32_5_4_3"] = "PointIndexGrid";
    return table;
  }();
  const auto name = names.find(grid.type());
  return name == names.end() ? grid.type() : name->second;
}

std::string classOf(const openvdb::GridBase& grid) {
  return openvdb::GridBase::gridClassToMenuName(grid.getGridClass()) == "Other"
             ? "unknown"
             : openvdb::GridBase::gridClassToString(grid.getGridClass());
}

std::string unitOf(const openvdb::GridBase& grid, const std::string& unit_if_missing,
                   const std::string& path) {
  std::string unit = textOf(grid, "length_unit");
  if (!unit.empty()) return unit;
  if (!unit_if_missing.empty()) return unit_if_missing;
  throw inputError("vdb.no_unit",
                   "grid '" + grid.getName() + "' does not say in which length unit it is",
                   "give the unit with it (--units mm; in a scene units: mm), or write it as "
                   "string metadata 'length_unit' "
                   "(m, cm, mm) into the grid",
                   path);
}

VdbFile::VdbFile(std::string path) : path_(std::move(path)) {
  openToRead(path_, buffer_);
  stream_.exceptions(std::ios::failbit | std::ios::badbit);
  readingFrom(path_, [&] { archive_.open(stream_); });
}

const VdbArchive::Entry& VdbFile::choose(const std::string& name) const {
  const auto& entries = archive_.entries();
  if (entries.empty()) throw inputError("vdb.no_grid", "the file holds no grid", "", path_);
  if (name.empty()) {
    if (entries.size() == 1) return entries.front();
    throw inputError("vdb.which_grid",
                     "the file holds " + std::to_string(entries.size()) + " grids",
                     "name one of " + namesOf(archive_), path_);
  }
  for (const auto& entry : entries) {
    if (entry.name() == name || entry.grid->getName() == name) return entry;
  }
  throw inputError("vdb.no_grid", "there is no grid '" + name + "' in the file",
                   "it holds " + namesOf(archive_), path_);
}

openvdb::GridBase::Ptr VdbFile::read(const VdbArchive::Entry& entry) {
  return readingFrom(path_, [&] { return archive_.readGridOf(stream_, entry); });
}

std::uint64_t VdbFile::memoryOf(const VdbArchive::Entry& entry) {
  return readingFrom(path_, [&] {
    using Leaf = openvdb::FloatTree::LeafNodeType;
    const openvdb::GridBase::Ptr grid = VdbArchive::readTopologyOf(stream_, entry);
    const std::uint64_t voxels = grid->baseTree().leafCount() * Leaf::SIZE;
    return grid->memUsage() + voxels * sizeof(float);
  });
}

VdbGridSummary VdbFile::summaryOf(const VdbArchive::Entry& entry) {
  return readingFrom(path_, [&] {
    openvdb::GridBase::Ptr grid = entry.grid;
    // The half width follows from the background, which is stored in the tree only.
    if (grid->isType<openvdb::FloatGrid>()) grid = VdbArchive::readTopologyOf(stream_, entry);
    return VdbGridSummary{entry.name(), typeOf(*grid), classOf(*grid), infoOf(*grid, entry.name())};
  });
}

}  // namespace palpate::vdb
