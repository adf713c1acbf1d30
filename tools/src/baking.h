#pragma once
/// Whatever can be baked, as grids: what `bake` writes and `convert` takes further.

#include <vector>

#include "console.h"
#include "options.h"
#include "palpate/vdb/level_set.h"
#include "palpate/vdb/material_grid.h"

namespace palpate::tools {

struct BakedGrid {
  vdb::LevelSet grid;
  double seconds = 0.0;
  FieldPtr analytic = {};  ///< what it was made of, if that was no grid, mesh or image
};

/// One grid for each layer of a scene, for a mesh, for an image's threshold, or for each of its labels.
/// @throws Error: kUsage for options that do not apply to this kind of input.
/// A scene's maps of parameters are added to `materials`, if that is given.
[[nodiscard]] std::vector<BakedGrid> bakeInput(
    const BakeOptions& options, Console& console,
    std::vector<vdb::NamedMaterialGrid>* materials = nullptr);

}  // namespace palpate::tools
