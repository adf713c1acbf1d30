#pragma once
/// The scene's `grids`: layers made of formulas whose costly parts are to become grids.

#include "palpate/scene/scene_file.h"

namespace palpate {

/// Replaces the layers' fields by what the registry chooses. Call it after layers, ports and sheets
/// were read.
/// @throws Error (kInput) at the offending place.
void readGrids(const MapReader& reader, const SceneRegistry& registry, SceneDescription& scene);

}  // namespace palpate
