#pragma once
/// Names for a scene's walls, contents and ports in reports.

#include <string>
#include <vector>

#include "palpate/interior/port_machine.h"
#include "palpate/scene/description.h"
#include "palpate/scene/scene.h"
#include "palpate/scene/transitions.h"

namespace palpate::tools {

/// Null for an index below 0.
[[nodiscard]] const Material* materialOf(const Scene& scene, int index);
/// "skin (300 N/m)", for the material of a wall.
[[nodiscard]] std::string materialText(const Material& wall);
/// The same, "absent", or "-" if there is no wall.
[[nodiscard]] std::string wallText(const Scene& scene, const Wall& wall);
[[nodiscard]] std::string contentText(const Material& content);
/// The description of a port as it was written; null for one that the scene made by itself.
[[nodiscard]] const PortDescription* describedPort(const SceneDescription& description,
                                                   const std::string& name);
/// Where and when a port is open.
[[nodiscard]] std::vector<std::string> conditionsOf(const Transition& t, const Scene& scene,
                                                    const SceneDescription& description);
[[nodiscard]] const char* directionName(PortDirection direction);
[[nodiscard]] const char* reachName(Reach reach);
/// Why the probe cannot get into a region.
[[nodiscard]] std::string whyUnreachable(const Scene& scene, RegionId region);

}  // namespace palpate::tools
