#pragma once
/// Teaches scene files to read grids, meshes and scans.

#include <functional>
#include <string>

#include "palpate/scene/scene_file.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// What a scene's heavy fields came to, for reports: one record for each grid that was made or read.
struct GridRecord {
  std::string what;  ///< layer or field, and its source
  LevelSetInfo info;
  double seconds = 0.0;  ///< [s] it took, reading its file included
};

struct RegisterOptions {
  std::function<void(const GridRecord&)> on_grid = {};   ///< told of each grid when it is ready
  std::function<void(const std::string&)> on_note = {};  ///< told what was assumed, once each
};

/// Adds `mesh` and `grid` to the field kinds, `labels` and `threshold` to the layer kinds, and the image
/// reader. The functions given must outlive the registry.
void registerKinds(SceneRegistry& registry, RegisterOptions options = {});

}  // namespace palpate::vdb
