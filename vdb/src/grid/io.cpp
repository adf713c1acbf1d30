#include "palpate/vdb/io.h"

#include <fcntl.h>
#include <openvdb/tree/LeafManager.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

#include "grid/vdb_archive.h"
#include "palpate/core/error.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

Error writeError(const std::string& path, const std::string& what) {
  return Error(ErrorKind::kOperation, {"vdb.write", what, "", path});
}

/// A new file beside the one that is wanted, gone again unless it was put in place.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : target_(path) {
    int file = -1;
    for (int n = 0; file < 0; ++n) {
      path_ = path + "." + std::to_string(getpid()) + "-" + std::to_string(n) + ".part";
      file = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file < 0 && errno != EEXIST) {
        throw writeError(target_, std::string("cannot be written: ") + strerror(errno));
      }
    }
    close(file);
  }
  ~TemporaryFile() {
    if (!path_.empty()) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  void putInPlace(bool overwrite) {
    synchronize(path_);
    // link() refuses where rename() would replace.
    const int failed =
        overwrite ? rename(path_.c_str(), target_.c_str()) : link(path_.c_str(), target_.c_str());
    if (failed != 0)
      throw writeError(target_, std::string("cannot be written: ") + strerror(errno));
    if (overwrite) path_.clear();
    const std::string folder = std::filesystem::path(target_).parent_path().string();
    synchronize(folder.empty() ? "." : folder);
  }

 private:
  void synchronize(const std::string& what) const {
    const int file = open(what.c_str(), O_RDONLY | O_CLOEXEC);
    const bool failed = file < 0 || (fsync(file) != 0 && errno != EINVAL);
    const int reason = errno;
    if (file >= 0) close(file);
    if (failed) throw writeError(target_, std::string("cannot be written: ") + strerror(reason));
  }

  std::string target_;
  std::string path_;
};

std::ifstream openToRead(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw inputError("vdb.missing", "there is no such file", "", path);
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw inputError("vdb.unreadable", "this is not a file", "", path);
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    throw inputError("vdb.unreadable", "the file cannot be opened for reading", "", path);
  stream.exceptions(std::ios::failbit | std::ios::badbit);
  return stream;
}

/// Runs `read`, and says in one way what a damaged file makes OpenVDB throw.
template <typename Read>
auto readingFrom(const std::string& path, const Read& read) {
  const char* const hint = "the file may be damaged or cut short; copy or write it again";
  const std::string what = "not a .vdb file that can be read: ";
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::ios_base::failure&) {
    throw inputError("vdb.unreadable", what + "it ends early", hint, path);
  } catch (const std::bad_alloc&) {
    throw inputError("vdb.unreadable", what + "it asks for more memory than there is", hint, path);
  } catch (const std::exception& error) {
    throw inputError("vdb.unreadable", what + error.what(), hint, path);
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

LevelSetInfo infoOf(const openvdb::GridBase& grid, const std::string& name) {
  LevelSetInfo info;
  info.name = name;
  info.length_unit = textOf(grid, "length_unit");
  info.metres_per_unit = metresPer(info.length_unit).value_or(1.0);
  const double scale = grid.voxelSize().x();
  info.voxel_size = scale * info.metres_per_unit;
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
      info.bounds.include(Vec3(p.x(), p.y(), p.z()) * info.metres_per_unit);
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

const VdbArchive::Entry& choose(const VdbArchive& archive, const std::string& name,
                                const std::string& path) {
  const auto& entries = archive.entries();
  if (entries.empty()) throw inputError("vdb.no_grid", "the file holds no grid", "", path);
  if (name.empty()) {
    if (entries.size() == 1) return entries.front();
    throw inputError("vdb.which_grid",
                     "the file holds " + std::to_string(entries.size()) + " grids",
                     "name one of " + namesOf(archive), path);
  }
  for (const auto& entry : entries) {
    if (entry.name() == name || entry.grid->getName() == name) return entry;
  }
  throw inputError("vdb.no_grid", "there is no grid '" + name + "' in the file",
                   "it holds " + namesOf(archive), path);
}

/// A level set of floats, or why not.
void requireLevelSet(const openvdb::GridBase& grid, const std::string& path) {
  const std::string name = "grid '" + grid.getName() + "'";
  if (!grid.isType<openvdb::FloatGrid>()) {
    throw inputError("vdb.type", name + " is a " + typeOf(grid) + "; a surface is read from floats",
                     "convert it to a FloatGrid of signed distances", path);
  }
  if (grid.getGridClass() == openvdb::GRID_FOG_VOLUME) {
    throw inputError("vdb.class",
                     name + " is a fog volume: it holds densities, not signed distances",
                     "export it as a level set (in Blender and Houdini: VDB type SDF)", path);
  }
  if (grid.getGridClass() != openvdb::GRID_LEVEL_SET) {
    throw inputError("vdb.class",
                     name + " is of class '" + classOf(grid) +
                         "', so nothing says that its values "
                         "are signed distances",
                     "if they are, set the grid's class to 'level set' and write it again", path);
  }
}

void requireFiniteVoxels(const openvdb::FloatGrid& grid, const std::string& path) {
  std::atomic<bool> broken = false;
  openvdb::tree::LeafManager<const openvdb::FloatTree> leaves(grid.tree());
  leaves.foreach ([&](const openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
    const float* const values = leaf.buffer().data();
    for (openvdb::Index i = 0; i < openvdb::FloatTree::LeafNodeType::SIZE; ++i) {
      if (!std::isfinite(values[i])) broken.store(true, std::memory_order_relaxed);
    }
  });
  if (broken) {
    throw inputError("vdb.not_finite",
                     "grid '" + grid.getName() + "' has voxels that are no numbers",
                     "the file may be damaged; write it again", path);
  }
}

std::string unitOf(const openvdb::GridBase& grid, const std::string& unit_if_missing,
                   const std::string& path) {
  std::string unit = textOf(grid, "length_unit");
  if (!unit.empty()) return unit;
  if (!unit_if_missing.empty()) return unit_if_missing;
  throw inputError("vdb.no_unit",
                   "grid '" + grid.getName() + "' does not say in which length unit it is",
                   "give the unit with the file, or write it as string metadata 'length_unit' "
                   "(m, cm, mm) into the grid",
                   path);
}

/// The same problem, with the file it is in.
[[noreturn]] void rethrowWithFile(const Error& error, const std::string& path) {
  Problem problem = error.problem();
  problem.file = path;
  throw Error(error.kind(), std::move(problem));
}

}  // namespace

void writeVdb(const std::string& path, std::span<const LevelSet> grids, bool overwrite) {
  std::error_code error;
  if (!overwrite && std::filesystem::exists(path, error)) {
    throw Error(ErrorKind::kOperation, {"file.exists", "the file exists already",
                                        "allow overwriting, or name another", path});
  }
  openvdb::GridCPtrVec pointers;
  for (const LevelSet& grid : grids) pointers.push_back(grid.impl().grid);
  TemporaryFile file(path);
  try {
    std::ofstream stream(file.path(), std::ios::binary | std::ios::trunc);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    VdbArchive().writeTo(stream, pointers);
    stream.close();
  } catch (const std::ios_base::failure&) {
    throw writeError(path, std::string("writing failed: ") + strerror(errno));
  } catch (const openvdb::Exception& failure) {
    throw writeError(path, std::string("writing failed: ") + failure.what());
  }
  file.putInPlace(overwrite);
}

std::vector<VdbGridSummary> listVdb(const std::string& path) {
  std::ifstream stream = openToRead(path);
  return readingFrom(path, [&] {
    VdbArchive archive;
    archive.open(stream);
    std::vector<VdbGridSummary> list;
    for (const auto& entry : archive.entries()) {
      openvdb::GridBase::Ptr grid = entry.grid;
      // The half width is the background, which only the tree knows.
      if (grid->isType<openvdb::FloatGrid>()) grid = VdbArchive::readTopologyOf(stream, entry);
      list.push_back({entry.name(), typeOf(*grid), classOf(*grid), infoOf(*grid, entry.name())});
    }
    return list;
  });
}

LevelSet readVdb(const std::string& path, const std::string& name,
                 const std::string& unit_if_missing) {
  std::ifstream stream = openToRead(path);
  return readingFrom(path, [&] {
    VdbArchive archive;
    archive.open(stream);
    const VdbArchive::Entry& entry = choose(archive, name, path);
    requireLevelSet(*entry.grid, path);
    const std::string unit = unitOf(*entry.grid, unit_if_missing, path);
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(archive.readGridOf(stream, entry));
    requireFiniteVoxels(*grid, path);
    try {
      LevelSet set = makeLevelSet(grid, unit);
      if (set.info().active_voxels == 0) {
        throw inputError("vdb.empty", "grid '" + grid->getName() + "' has no voxels");
      }
      if (set.info().half_width < 2.0) {
        throw inputError("vdb.narrow",
                         "the band of grid '" + grid->getName() + "' is " +
                             std::to_string(set.info().half_width) +
                             " voxels wide on each side; at least 2 are needed",
                         "write it again with a half width of 3 or more");
      }
      return set;
    } catch (const Error& problem) {
      rethrowWithFile(problem, path);
    }
  });
}

}  // namespace palpate::vdb
