#pragma once
/// The sections of `palpate explain`, in words for people and under their keys for programs.

#include <string>

#include "explain/scene_words.h"
#include "loaded_scene.h"
#include "options.h"
#include "report.h"

namespace palpate::tools {

/// How the device is placed in the scene.
void addDevice(const Scene& scene, Report& report);
void addRegions(const Scene& scene, Report& report);
/// Walls between regions, and sheets within one.
void addWalls(const Scene& scene, Report& report);
void addPorts(const Scene& scene, const SceneDescription& description, Report& report);
void addTransitions(const Scene& scene, const SceneDescription& description, Report& report);
/// The table of transitions as an SVG page.
[[nodiscard]] std::string transitionPicture(const Scene& scene, const SceneDescription& description,
                                            const std::string& title);
/// Parameters that differ from place to place.
void addMaps(const Scene& scene, const SceneDescription& description, Report& report);
/// Contrasts of stiffness, and shading that needs a wider band than a grid has.
void addWallNotes(const Scene& scene, Report& report);
/// Limits of the device, if one is named, and the scene's stability budget at `rate` [Hz].
void addStability(const Scene& scene, const DeviceOptions& device, double rate, Report& report);
/// The sources of fields and layers, whether they were made, and the cost of the grids.
void addSources(const Scene& scene, const LoadedScene& loaded, Report& report);
/// Makes the scene anew, as a whole and only its needed part, and gives the cost of each.
void addMeasured(const std::string& file, Console& console, Report& report);

}  // namespace palpate::tools
