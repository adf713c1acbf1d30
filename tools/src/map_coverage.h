#pragma once
/// Whether maps of parameters lie where the layers are that use them.

#include <optional>
#include <string>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/scene/scene.h"

namespace palpate::tools {

/// A map that does not cover all of its layer. Beyond its voxels a map goes on as at its rim.
struct MapGap {
  std::string parameter;  ///< "skin/stiffness"
  std::string source;     ///< the file
  double share = 0.0;     ///< [0..1] of the layer's places that lie within the map
  double away = 0.0;      ///< [m] from the layer to the map, where it covers nothing
  double size_ratio =
      1.0;  ///< longest side of the map over that of the layer; 1 if the layer has none
  [[nodiscard]] bool misses() const noexcept { return share <= 0.0; }
};

/// Looked at in some thousand places of each layer whose parameters are maps of voxels; of a port,
/// those of the layers that it leads into. Shares above 99.5 % are whole: the layer's rim may lie
/// within half a voxel of the map's.
[[nodiscard]] std::vector<MapGap> mapGaps(const SceneDescription& description, const Scene& scene);

/// "the map of skin/stiffness (map.vdb) does not reach its layer: ..." `unit` is that of the scene.
[[nodiscard]] std::string gapText(const MapGap& gap, const std::string& unit,
                                  double meters_per_unit);

}  // namespace palpate::tools
