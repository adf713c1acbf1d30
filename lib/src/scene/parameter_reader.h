#pragma once
/// Parameters of materials and opening forces: constants, or maps that other modules read.

#include <optional>
#include <string>
#include <string_view>

#include "palpate/materials/material.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

/// The parameter at `key`, 0 or more everywhere; `fallback` if it is not there. A constant is a quantity of
/// `dimension`, or a number where there is none; a map of keys is read by the registry. @throws Error (kInput)
/// at the offending place.
[[nodiscard]] Parameter readParameter(MapReader& reader, std::string_view key,
                                      std::optional<Dimension> dimension, Parameter fallback);

/// The same where it must be given.
[[nodiscard]] Parameter requireParameter(MapReader& reader, std::string_view key,
                                         std::optional<Dimension> dimension);

/// A component of a velocity: a quantity, or a map of keys, below 0 too. `key` is of the list it stands in.
[[nodiscard]] Parameter readVelocity(const SceneLoader& loader, const Node& node,
                                     const std::string& key);

}  // namespace palpate
