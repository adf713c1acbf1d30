#pragma once
/// What every material must hold to, also one that no scene file was read for.

#include "palpate/materials/material.h"

namespace palpate {

/// @throws Error (kInput) that names the material and what is wrong with it.
void checkMaterial(const Material& material);

}  // namespace palpate
