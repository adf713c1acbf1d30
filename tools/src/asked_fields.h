#pragma once
/// Fields and layers of a compiled scene, by name.

#include <string>
#include <vector>

#include "palpate/scene/scene.h"

namespace palpate::tools {

struct AskedField {
  std::string name;
  FieldPtr field;
  bool layer = false;       ///< a layer, not a named field
  std::string source = {};  ///< what it was made from; empty if analytic
};

/// The layer, or else the field, called `name`; every layer if `name` is empty.
/// @throws Error (kInput, `code`) with a suggestion if there is none.
[[nodiscard]] std::vector<AskedField> chooseFields(const Scene& scene, const std::string& name,
                                                   const char* code);

[[nodiscard]] const char* metricName(Metric metric);

}  // namespace palpate::tools
