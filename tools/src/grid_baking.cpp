#include "grid_baking.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "input_kind.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/grid_image.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/scan_surface.h"
#include "scan_options.h"
#include "scene_baking.h"
#include "text.h"
#include "vdb_grid_name.h"

namespace palpate::tools {
namespace {

Error usageError(std::string message, std::string hint = {}) {
  return Error(ErrorKind::kUsage, {"usage.bake", std::move(message), std::move(hint)});
}

std::string askedName(const BakeOptions& options) {
  if (options.layers.size() > 1) {
    throw usageError("--layer was given twice; this output is made from one grid");
  }
  return gridName(options.input, options.layers.empty() ? "" : options.layers.front());
}

/// A summary of the grid, read without its voxels; nothing if there is no such grid.
std::optional<vdb::VdbGridSummary> summaryOf(const BakeOptions& options, const std::string& name) {
  for (vdb::VdbGridSummary& grid : vdb::listVdb(options.input)) {
    if (name.empty() || grid.name == name) return std::move(grid);
  }
  return {};
}

/// "liver" for "liver/surface"; the file's name for a grid without a name.
std::string layerOf(const std::string& grid, const BakeOptions& options) {
  constexpr std::string_view kEnd = "/surface";
  if (grid.empty()) return stemOf(options.input);
  return grid.ends_with(kEnd) ? grid.substr(0, grid.size() - kEnd.size()) : grid;
}

vdb::BakeOptions bakeOptions(const BakeOptions& options, const std::string& grid,
                             const std::string& unit, double voxel) {
  vdb::BakeOptions bake;
  bake.voxel_size = voxel;
  bake.half_width = options.half_width;
  bake.max_memory = memoryLeft(options);
  const std::string layer = layerOf(grid, options);
  bake.name = layer + "/surface";
  bake.length_unit = unit;
  bake.metadata = {{"layer", layer}, {"source", options.input}};
  return bake;
}

double voxelOr(const BakeOptions& options, const std::string& unit, double fallback) {
  if (options.voxel.empty()) return fallback;
  const double voxel = parseLength(options.voxel, lengthUnit(unit), "--voxel");
  if (!(voxel > 0.0)) throw usageError("--voxel must be greater than 0");
  return voxel;
}

/// For a level set whose voxels are not cubes along the axes: makes new voxels from the surface
/// where its interpolated distances pass zero.
vdb::LevelSet straightened(const BakeOptions& options, Console& console) {
  const auto grid = summaryOf(options, askedName(options));
  const std::string name = grid ? grid->name : "";
  const std::string unit = unitOfGrid(options);
  vdb::Image image = readDistances(options, console);
  for (float& value : image.values) value = -value;
  const double spacing = std::min(
      {glm::length(image.axes[0]), glm::length(image.axes[1]), glm::length(image.axes[2])});
  const double voxel = voxelOr(options, unit, spacing);
  console.note(options.input + ": its surface is put into cubic voxels of " +
               formatNumber(voxel / lengthUnit(unit).meters, 3) + " " + unit + " along the axes");
  vdb::ThresholdOptions threshold;
  threshold.largest_component = false;
  return vdb::surfaceFromThreshold(image, threshold, bakeOptions(options, name, unit, voxel),
                                   console.progress());
}

void tellMarked(const BakeOptions& options, std::uint64_t voxels, Console& console) {
  if (voxels == 0) return;
  console.note(options.input + ": its inside was not marked; " + formatCount(voxels) +
               " voxels behind the band were marked, the band itself is unchanged");
}

}  // namespace

std::string unitOfGrid(const BakeOptions& options) {
  const auto grid = summaryOf(options, askedName(options));
  return grid && !grid->info.length_unit.empty() ? grid->info.length_unit : options.units;
}

vdb::MarkedInside readLevelSet(const BakeOptions& options, Console& console) {
  vdb::MarkedInside read = vdb::withInsideMarked(
      vdb::readVdb(options.input, askedName(options), options.units,
                   options.level_set ? vdb::UnknownClass::kLevelSet : vdb::UnknownClass::kRefuse),
      options.input);
  tellMarked(options, read.voxels, console);
  return read;
}

bool isMendable(const Error& error, const BakeOptions& options) {
  if (error.problem().code == "vdb.transform") return true;
  if (error.problem().code != "vdb.type") return false;
  const auto grid = summaryOf(options, askedName(options));
  return grid && grid->type == "DoubleGrid";
}

vdb::Image readDistances(const BakeOptions& options, Console& console) {
  const std::string name = askedName(options);
  const auto grid = summaryOf(options, name);
  const std::string grid_class = grid ? grid->grid_class : "";
  if (grid_class != "level set" && !(options.level_set && grid_class == "unknown")) {
    throw inputError(
        "vdb.class",
        "grid '" + name + "' has the class '" + grid_class +
            "', which does not say that its values are signed distances",
        "if they are, say so: --level-set; --above DENSITY or --labels VALUE put a surface "
        "around its voxels",
        options.input);
  }
  vdb::DistanceImage read = vdb::readVdbDistances(options.input, name, options.units);
  tellMarked(options, read.marked_inside, console);
  return std::move(read.image);
}

BakedGrid rebakeGrid(const BakeOptions& options, Console& console) {
  const auto start = std::chrono::steady_clock::now();
  BakedGrid baked;
  vdb::MarkedInside read;
  try {
    read = readLevelSet(options, console);
  } catch (const Error& error) {
    if (!isMendable(error, options)) throw;
    baked.grid = straightened(options, console);
  }
  if (read.voxels > 0 && options.voxel.empty()) {
    baked.grid = read.grid;
  } else if (read.grid) {
    const vdb::LevelSetInfo& info = read.grid.info();
    if (options.voxel.empty()) {
      throw usageError(
          "this is a .vdb file already",
          "--voxel puts its surface into other voxels; meshes (.stl .obj .ply .glb) and "
          ".nii.gz can be written too");
    }
    const double voxel = voxelOr(options, info.length_unit, 0.0);
    // The half width of the new band, plus the reach of a cubic sample at its rim.
    const double band = options.half_width * voxel / info.voxel_size + vdb::kCubicHalfWidth;
    const FieldPtr field = vdb::gridField(vdb::widened(read.grid, band, console.progress()));
    baked.grid = vdb::bake(*field, bakeOptions(options, info.name, info.length_unit, voxel),
                           console.progress());
  }
  baked.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return baked;
}

std::vector<BakedGrid> inTheSameFrame(const BakeOptions& options, std::vector<BakedGrid> grids) {
  const auto old = summaryOf(options, askedName(options));
  std::string frame = "world";
  if (old && old->info.metadata.contains("frame")) frame = old->info.metadata.at("frame");
  for (BakedGrid& one : grids) {
    one.grid = one.grid.named(one.grid.info().name, {{"frame", frame}});
  }
  return grids;
}

vdb::Image readVoxels(const BakeOptions& options, std::string& length_unit) {
  if (inputKind(options.input) == InputKind::kImage) {
    length_unit = "mm";
    return vdb::readImage(options.input, imageOptions(options.scan));
  }
  const std::string name = askedName(options);
  length_unit = unitOfGrid(options);
  return vdb::readVdbImage(options.input, name, options.units);
}

}  // namespace palpate::tools
