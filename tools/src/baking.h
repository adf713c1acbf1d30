#pragma once
/// Bakes every kind of input to grids: `bake` writes them, and `convert` processes them further.

#include <vector>

#include "console.h"
#include "options.h"
#include "palpate/vdb/level_set.h"
#include "palpate/vdb/material_grid.h"

namespace palpate::tools {

struct BakedGrid {
  vdb::LevelSet grid;
  double seconds = 0.0;
  FieldPtr analytic = {};  ///< the field it was made from, if that was not a grid, mesh or image
};

/// The grid of all labels together. A point belongs to the label whose grid has the smallest value
/// there, or to none if the negative of this grid's value is smaller still. Labels thus leave no
/// gap and do not overlap (vdb::LabelSurfaces).
inline constexpr const char* kUnitedGrid = "united";

/// Makes one grid for each layer of a scene, for a mesh, for an image's threshold, or for each of
/// its labels; and one more for all labels together, if some of them meet.
/// @throws Error: kUsage for options that do not apply to this kind of input.
/// A scene's maps of parameters are added to `materials`, if that is given.
[[nodiscard]] std::vector<BakedGrid> bakeInput(
    const BakeOptions& options, Console& console,
    std::vector<vdb::NamedMaterialGrid>* materials = nullptr);

}  // namespace palpate::tools
