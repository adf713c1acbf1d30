#pragma once
/// Parameters of materials and opening forces: constants, or maps that other modules read.

#include <string_view>

#include "palpate/materials/material.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

/// The parameter at a declared key, within the key's bounds everywhere; if absent, the declared
/// default, or 0. A map of keys is read by the registry. @throws Error (kInput) at the offending
/// place.
[[nodiscard]] Parameter readParameter(const MapReader& reader, std::string_view key);
/// The same; if absent, `fallback`.
[[nodiscard]] Parameter readParameter(const MapReader& reader, std::string_view key,
                                      Parameter fallback);

/// The three components of a declared list of velocities, each a quantity or a map; negative ones
/// are allowed.
[[nodiscard]] Flow readFlow(const MapReader& reader, std::string_view key);

}  // namespace palpate
