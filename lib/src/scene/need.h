#pragma once
/// Which layers a scene needs, found before costly ones are made: names and boxes come cheap.

#include <string>
#include <vector>

#include "palpate/scene/description.h"

namespace palpate {

/// [m] What of the world can matter to the probe: what the device reaches, grown by how far contact looks
/// beyond it. Everything if that has no bounds, and for the paper's renderer.
[[nodiscard]] Box3 neededBox(const SceneDescription& description);

/// By layer: why it need not be made; empty if it is needed. Only layers that cost work are ever left out, and
/// only where it is certain that the probe cannot feel the difference:
/// - its box lies beyond the device's workspace; or
/// - no way of ports and absent walls, by their names and in the order that `after` asks for, leads from the
///   start into it (undecided: one may), no region that one
///   leads into comes near its box, and neither does the space outside: that is out of reach as well, or
///   another such layer lies all around the box.
/// May make the layers that lie around others.
[[nodiscard]] std::vector<std::string> reasonsToLeaveOut(const SceneDescription& description,
                                                         const Progress& progress);

}  // namespace palpate
