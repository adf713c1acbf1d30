#include "scene_mask.h"

#include <algorithm>

#include "palpate/core/error.h"
#include "palpate/vdb/grid_image.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/scan_surface.h"

namespace palpate::vdb {
namespace {

constexpr double kHalfDense = 0.5;

bool isDensity(const VdbGridSummary& grid) {
  return grid.type == "FloatGrid" || grid.type == "DoubleGrid";
}

VdbGridSummary chosen(const MaskOptions& options) {
  std::vector<VdbGridSummary> grids = listVdb(options.file);
  std::string names;
  for (const VdbGridSummary& grid : grids) {
    if (grid.name == options.name || (options.name.empty() && grids.size() == 1)) return grid;
    names += (names.empty() ? "" : ", ") + grid.name;
  }
  throw inputError("vdb.no_grid",
                   options.name.empty() ? "the file holds several grids"
                                        : "there is no grid '" + options.name + "' in it",
                   "it holds " + names, options.file);
}

}  // namespace

LevelSet surfaceOfMask(const MaskOptions& options, const BakeOptions& bake,
                       const Progress& progress) {
  const VdbGridSummary grid = chosen(options);
  if (grid.grid_class == "level set") {
    throw inputError("vdb.class", grid.name + " is a level set, which holds distances, not a mask",
                     "write grid: {file: ...} instead of mask", options.file);
  }
  if (options.above && !isDensity(grid)) {
    throw inputError("vdb.class", grid.name + " is a " + grid.type + " and has no densities",
                     "leave out above", options.file);
  }
  Image image = readVdbImage(options.file, grid.name, options.unit_if_missing);
  if (isDensity(grid)) {
    ThresholdOptions threshold;
    threshold.above = options.above.value_or(kHalfDense);
    threshold.largest_component = false;
    threshold.voxel_size = options.voxel_size;
    return surfaceFromThreshold(image, threshold, bake, progress);
  }
  for (float& value : image.values) value = value != 0.0F ? 1.0F : 0.0F;
  return surfaceFromLabels(image, {{1}, options.voxel_size}, bake, progress);
}

}  // namespace palpate::vdb
