#pragma once
/// Checks whether maps of parameters lie where the layers that use them are.

#include <optional>
#include <string>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/scene/scene.h"

namespace palpate::tools {

/// A map that does not cover all of its layer. Beyond its voxels a map continues with its border
/// values.
struct MapGap {
  std::string parameter;  ///< "skin/stiffness"
  std::string source;     ///< the file
  double share = 0.0;     ///< [0..1] share of the layer's sample places that are within the map
  double away = 0.0;  ///< [m] distance from the layer to the map, if the map covers nothing of it
  double size_ratio =
      1.0;  ///< longest side of the map over that of the layer; 1 if the layer is unbounded
  [[nodiscard]] bool misses() const noexcept { return share <= 0.0; }
};

/// Samples some thousand places of each layer whose parameters are maps of voxels; for a port,
/// places of the layers that it leads into. Shares above 99.5 % count as whole: the layer's border
/// may be within half a voxel of the map's.
[[nodiscard]] std::vector<MapGap> mapGaps(const SceneDescription& description, const Scene& scene);

/// "the map of skin/stiffness (map.vdb) does not reach its layer: ..." `unit` is that of the scene.
[[nodiscard]] std::string gapText(const MapGap& gap, const std::string& unit,
                                  double meters_per_unit);

}  // namespace palpate::tools
