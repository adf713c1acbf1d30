#pragma once
/// Which layers a scene needs, found before costly ones are made: names and boxes come cheap.

#include <string>
#include <vector>

#include "palpate/scene/description.h"

namespace palpate {

/// [m] What of the world can matter to the probe: what the device reaches, grown by how far contact
/// looks beyond it. Everything if that has no bounds, and for the paper's renderer.
[[nodiscard]] Box3 neededBox(const SceneDescription& description);

/// For each layer the reason why it need not be made; empty if it is needed. Only layers that cost
/// work are ever left out, and only where it is certain that the probe cannot feel the difference:
/// - the layer's box lies beyond the device's workspace; or
/// - no way through ports and absent walls, by their names and in the order that `after` asks for,
/// leads
///   from the start into the layer (where that is undecided, one may), and no region that the probe
///   can reach comes near the layer's box. The space outside counts as such a region unless it is
///   out of reach as well, or another layer that is left out lies all around the box.
/// Makes layers that lie around others where it has to know their boxes.
[[nodiscard]] std::vector<std::string> reasonsToLeaveOut(const SceneDescription& description,
                                                         const Progress& progress);

}  // namespace palpate
