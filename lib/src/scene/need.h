#pragma once
/// Finds which layers a scene needs before costly ones are made: names and boxes are cheap.

#include <string>
#include <vector>

#include "palpate/scene/description.h"

namespace palpate {

/// [m] The part of the world that can matter to the probe: the device's reach, grown by how far
/// contact looks beyond it. All space if the reach is not bounded, and for the paper's renderer.
[[nodiscard]] Box3 neededBox(const SceneDescription& description);

/// For each layer the reason why it need not be made; empty if it is needed. Only costly layers are
/// ever left out, and only where it is certain that the probe cannot feel the difference:
/// - the layer's box lies beyond the device's workspace; or
/// - no way leads from the start into the layer, through ports and absent walls, judged by their
///   names and by the order that `after` demands (an undecided way counts as one), and no region
///   that the probe can reach comes near the layer's box. The space outside counts as such a region
///   unless it is out of reach as well, or another layer that is left out encloses the box.
///
/// Makes layers that enclose others where their exact shape is needed.
[[nodiscard]] std::vector<std::string> reasonsToLeaveOut(const SceneDescription& description,
                                                         const Progress& progress);

}  // namespace palpate
