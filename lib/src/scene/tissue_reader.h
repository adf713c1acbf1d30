#pragma once
/// Reads the properties of tissue in a material: nonlinear springs, relaxation, lattices, and
/// needles.

#include <utility>

#include "palpate/materials/material.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

/// `static`, and `kinetic`, which must not be larger; if `kinetic` is absent it equals `static`.
[[nodiscard]] std::pair<Parameter, Parameter> readFriction(const MapReader& reader);

/// Reads `curve`, `maxwell`, `lattice`, `cutting` and `shaft` of a material whose stiffness is
/// known.
/// @throws Error (kInput) at the offending value.
void readTissue(const MapReader& reader, Material& material);

}  // namespace palpate
