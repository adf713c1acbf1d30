#pragma once
/// The table of a scene's states and transitions.

#include <optional>
#include <vector>

#include "palpate/scene/scene.h"

namespace palpate {

/// One row: from a region, by a port or where there is no wall, to a region that it touches.
struct Transition {
  RegionId from = kOutside;
  RegionId to = kOutside;
  std::optional<PortId> port = {};  ///< none: there is no wall
  Parameter force = 0.0;            ///< [N] at which the port opens this way; 0: it is open
};

/// All rows, by regions and then in the author's order of ports. Ports of sheets, which lead from a
/// region to itself, are not included. Region::reach and Scene::reachOf() say which rows a probe
/// can ever take, from the start and with ports in their order. Set-up thread.
[[nodiscard]] std::vector<Transition> transitions(const Scene& scene);

}  // namespace palpate
