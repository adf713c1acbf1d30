#pragma once
/// A scene baked in parts: grids of what is smooth, and a scene that puts them together with its
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
  std::string scene;  ///< the text of the scene file `options.parts`
};

/// Of each layer asked for that is given by `inside`: grids of the parts that a grid holds and that
/// are not exact by themselves. Faces that ports are on stay as they are.
/// @throws Error: kUsage for inputs other than scenes; kOperation if no part became a grid.
[[nodiscard]] BakedParts bakeParts(const BakeOptions& options, Console& console);

}  // namespace palpate::tools
