#pragma once
/// Bakes a scene in parts: grids of the smooth parts, and a scene that combines them with the exact
/// edges.

#include <string>
#include <vector>

#include "baking.h"
#include "palpate/vdb/bake.h"

namespace palpate::tools {

struct LayerParts {
  std::string layer;
  std::vector<vdb::HybridPart> parts;
  double seconds = 0.0;
};

struct BakedParts {
  std::vector<LayerParts> layers;
  std::string scene;  ///< text for the scene file `options.parts`
};

/// For each requested layer given by `inside`: grids of the parts that a grid can hold and that are
/// not exact already. Faces that carry ports stay as they are.
/// @throws Error: kUsage for inputs other than scenes; kOperation if no part became a grid.
[[nodiscard]] BakedParts bakeParts(const BakeOptions& options, Console& console);

}  // namespace palpate::tools
