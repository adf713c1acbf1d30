#include <openvdb/tree/LeafManager.h>

#include <atomic>
#include <cmath>
#include <utility>

#include "bake/bake_plan.h"
#include "grid/vdb_file.h"
#include "palpate/core/error.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/grid_memory.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

/// The remedy for a grid that does not hold floats.
std::string typeHint(const std::string& type) {
  if (type == "DoubleGrid") return "palpate convert FILE.vdb -o OTHER.vdb makes a FloatGrid of it";
  if (type.starts_with("Vec")) return "a surface needs one number a voxel, not a vector";
  if (type.starts_with("Point")) {
    return "make a level set of its points first, with OpenVDB's particlesToSdf or vdb_tool";
  }
  return "palpate convert FILE.vdb -o OTHER.vdb puts a surface around its voxels, with --labels "
         "VALUE or --above VALUE";
}

bool isUnsigned(const openvdb::GridBase& grid) {
  const auto distance = grid.getMetadata<openvdb::StringMetadata>(kDistanceKey);
  return distance && distance->value() == kUnsignedDistance;
}

/// Throws with the reason if the grid is not a level set of floats.
void requireLevelSet(const openvdb::GridBase& grid, UnknownClass unknown_class,
                     const std::string& path) {
  const std::string name = "grid '" + grid.getName() + "'";
  const std::string type = typeOf(grid);
  if (type != "FloatGrid") {
    throw inputError("vdb.type", name + " is a " + type + "; a surface is read from floats",
                     typeHint(type), path);
  }
  if (grid.getGridClass() == openvdb::GRID_FOG_VOLUME) {
    throw inputError(
        "vdb.class", name + " is a fog volume: it holds densities, not signed distances",
        "palpate convert FILE.vdb -o OTHER.vdb --above DENSITY puts a surface where the "
        "density passes a value, and in a scene mask: {file: ...}; or export it as a level set "
        "(Blender, Houdini: SDF)",
        path);
  }
  const bool says_nothing = grid.getGridClass() == openvdb::GRID_UNKNOWN;
  if (says_nothing && unknown_class == UnknownClass::kLevelSet) return;
  if (isUnsigned(grid)) {
    throw inputError(
        "vdb.class", name + " holds distances without sign: nothing is inside",
        "bake the mesh again, with --shell or another --sign; in a scene, grid: {file: ..., "
        "class: level_set} under an offset: {distance: ...} is a shell",
        path);
  }
  if (grid.getGridClass() != openvdb::GRID_LEVEL_SET) {
    throw inputError("vdb.class",
                     name + " has the class '" + classOf(grid) +
                         "', which does not say that its values "
                         "are signed distances",
                     says_nothing
                         ? "if they are, say so: --level-set, in a scene class: level_set; "
                           "densities become a surface by palpate convert --above DENSITY"
                         : "export it as a level set",
                     path);
  }
}

/// Nodes of a tree lie at multiples of their size. A node that damage has put elsewhere cannot be
/// found again.
void requireSoundBlocks(const openvdb::FloatGrid& grid, const std::string& path) {
  std::atomic<bool> not_finite = false;
  std::atomic<bool> misplaced = false;
  openvdb::tree::LeafManager<const openvdb::FloatTree> leaves(grid.tree());
  leaves.foreach ([&](const openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
    if (grid.tree().probeConstLeaf(leaf.origin()) != &leaf) {
      misplaced.store(true, std::memory_order_relaxed);
    }
    const float* const values = leaf.buffer().data();
    for (openvdb::Index i = 0; i < openvdb::FloatTree::LeafNodeType::SIZE; ++i) {
      if (!std::isfinite(values[i])) not_finite.store(true, std::memory_order_relaxed);
    }
  });
  const std::string hint = "the file may be damaged; write it again";
  if (misplaced) {
    throw inputError(
        "vdb.unreadable",
        "grid '" + grid.getName() + "' has voxels that are not where its tree has them", hint,
        path);
  }
  if (not_finite) {
    throw inputError("vdb.not_finite",
                     "grid '" + grid.getName() + "' has voxels that are not numbers", hint, path);
  }
}

/// Some tools leave all of the inside active, at minus the background. Such voxels are not part of
/// the band.
void endBandAtItsWidth(openvdb::FloatGrid& grid) {
  const float width = grid.background();
  if (!(width > 0.0F)) return;  // other code refuses this later
  openvdb::tree::LeafManager<openvdb::FloatTree> leaves(grid.tree());
  leaves.foreach ([&](openvdb::FloatTree::LeafNodeType& leaf, std::size_t) {
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
      if (std::abs(*voxel) >= width) voxel.setValueOff();
    }
  });
  auto tile = grid.tree().beginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    if (std::abs(*tile) >= width) tile.setActiveState(false);
  }
}

/// Leaves and nodes are counted before any of their values are read.
void requireMemory(VdbFile& file, const VdbArchive::Entry& entry, std::uint64_t limit,
                   const std::string& path) {
  const std::uint64_t bytes = file.memoryOf(entry);
  if (bytes <= limit) return;
  throw Error(
      ErrorKind::kOperation,
      {"vdb.memory",
       "grid '" + entry.name() + "' takes " + inGigabytes(static_cast<double>(bytes)) + ", " +
           inGigabytes(static_cast<double>(limit)) + " are allowed",
       "allow more, or put its surface into larger voxels: palpate convert --voxel SIZE", path});
}

/// Throws the same problem, with the name of its file.
[[noreturn]] void rethrowWithFile(const Error& error, const std::string& path) {
  Problem problem = error.problem();
  problem.file = path;
  throw Error(error.kind(), std::move(problem));
}

}  // namespace

LevelSet acceptLevelSet(const openvdb::GridBase::Ptr& base, const std::string& unit_if_missing,
                        UnknownClass unknown_class, const std::string& path) {
  requireLevelSet(*base, unknown_class, path);
  const std::string unit = unitOf(*base, unit_if_missing, path);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
  requireSoundBlocks(*grid, path);
  endBandAtItsWidth(*grid);
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
}

std::vector<VdbGridSummary> listVdb(const std::string& path) {
  VdbFile file(path);
  std::vector<VdbGridSummary> list;
  for (const auto& entry : file.entries()) list.push_back(file.summaryOf(entry));
  return list;
}

LevelSet readVdb(const std::string& path, const std::string& name,
                 const std::string& unit_if_missing, UnknownClass unknown_class,
                 std::uint64_t max_memory) {
  VdbFile file(path);
  const VdbArchive::Entry& entry = file.choose(name);
  // Refuse errors that the grid's header shows before reading voxels.
  requireLevelSet(*entry.grid, unknown_class, path);
  static_cast<void>(unitOf(*entry.grid, unit_if_missing, path));
  requireMemory(file, entry, memoryLimit(max_memory), path);
  return readingFrom(
      path, [&] { return acceptLevelSet(file.read(entry), unit_if_missing, unknown_class, path); });
}

LevelSet readVdb(const std::string& path, const std::string& name,
                 const std::string& unit_if_missing, UnknownClass unknown_class) {
  return readVdb(path, name, unit_if_missing, unknown_class, 0);
}

}  // namespace palpate::vdb
