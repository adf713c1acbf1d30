#pragma once
/// The rules for every material, also for one that does not come from a scene file.

#include "palpate/materials/material.h"

namespace palpate {

/// @throws Error (kInput) that names the material and the fault.
void checkMaterial(const Material& material);

}  // namespace palpate
