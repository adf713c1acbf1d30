#pragma once
/// The parameters of a scene that vary from place to place, under the names that files give them.

#include <string>
#include <vector>

#include "palpate/scene/description.h"
#include "palpate/vdb/material_grid.h"

namespace palpate::tools {

struct SceneParameter {
  std::string owner;      ///< the layer, or the port
  std::string parameter;  ///< "stiffness", "opens_at", ...
  std::string unit;       ///< SI: "N/m"; "1" for a ratio
  MaterialMapPtr map;

  [[nodiscard]] std::string name() const { return owner + "/" + parameter; }
  /// Null if the map is not made of voxels.
  [[nodiscard]] vdb::MaterialGridPtr grid() const {
    return std::dynamic_pointer_cast<const vdb::MaterialGrid>(map);
  }
};

/// The parameters of each layer's wall and content, and of each port; a map with several users is
/// listed for each.
[[nodiscard]] std::vector<SceneParameter> sceneParameters(const SceneDescription& description);

}  // namespace palpate::tools
