#pragma once
/// Reads the kinds of field that are described by numbers alone: solids and implicit functions
/// without operands.

#include <functional>
#include <string>
#include <string_view>

#include "palpate/scene/scene_file.h"

namespace palpate {

/// The function that makes the shape of `kind` from what `reader` holds; null if this reader does
/// not know the kind. The function may throw Error (kInput) without a place. @throws Error (kInput)
/// at the offending value.
[[nodiscard]] std::function<FieldPtr()> readShape(std::string_view kind, const MapReader& reader);

/// `meters` in the unit of the file, for messages: "12.5 mm".
[[nodiscard]] std::string inUnitOf(const SceneLoader& loader, double meters);

}  // namespace palpate
