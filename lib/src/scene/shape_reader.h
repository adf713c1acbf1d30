#pragma once
/// The kinds of field that numbers alone describe: solids and implicit functions with no field in
/// them.

#include <functional>
#include <string>
#include <string_view>

#include "palpate/scene/scene_file.h"

namespace palpate {

/// What makes the shape of `kind` that `reader` has; null if that is not a kind that it makes.
/// Making may throw Error (kInput) without a place. @throws Error (kInput) at the offending value.
[[nodiscard]] std::function<FieldPtr()> readShape(std::string_view kind, const MapReader& reader);

/// `meters` in the unit of the file, for messages: "12.5 mm".
[[nodiscard]] std::string inUnitOf(const SceneLoader& loader, double meters);

}  // namespace palpate
