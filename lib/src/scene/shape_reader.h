#pragma once
/// The kinds of field that numbers alone describe: solids and implicit functions with no field in them.

#include <functional>
#include <span>
#include <string_view>

#include "palpate/scene/scene_file.h"

namespace palpate {

/// Their YAML keys.
[[nodiscard]] std::span<const std::string_view> shapeKinds();

/// Reads the values of a shape of `kind`, one of shapeKinds(), and returns what makes it. Making may
/// throw Error (kInput) without a place. @throws Error (kInput) at the offending value.
[[nodiscard]] std::function<FieldPtr()> readShape(std::string_view kind, MapReader& reader);

/// A length of more than 0.
[[nodiscard]] double positiveLength(MapReader& reader, std::string_view key);

/// `metres` in the unit of the file, for messages: "12.5 mm".
[[nodiscard]] std::string inUnitOf(const SceneLoader& loader, double metres);

}  // namespace palpate
