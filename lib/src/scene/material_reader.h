#pragma once
/// The `materials` of a scene.

#include <vector>

#include "palpate/materials/material.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

/// Returns the materials in the order of the file. @throws Error (kInput) at the offending place.
[[nodiscard]] std::vector<Material> readMaterials(const SceneLoader& loader, const Node& materials);

}  // namespace palpate
