#pragma once
/// What a material says of tissue: curved springs, relaxation, lattices, and needles.

#include "palpate/materials/material.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

/// Reads `curve`, `maxwell`, `lattice`, `cutting` and `shaft` of a material whose stiffness is known.
/// @throws Error (kInput) at the offending value.
void readTissue(MapReader& reader, Material& material);

}  // namespace palpate
