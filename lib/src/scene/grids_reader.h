#pragma once
/// The scene's `grids`: layers made of formulas whose costly parts are to become grids.

#include "palpate/scene/scene_file.h"

namespace palpate {

/// Puts what the registry chooses in the place of the layers' fields. Layers, ports and sheets are
/// known already.
/// @throws Error (kInput) at the offending place.
void readGrids(const MapReader& reader, const SceneRegistry& registry, SceneDescription& scene);

}  // namespace palpate
