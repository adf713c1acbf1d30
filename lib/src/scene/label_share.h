#pragma once
/// Layers out of one label image share its points: each point belongs to the label whose field is
/// smallest, so that touching organs have one wall and no sliver between them (DESIGN.md section 2).

#include <vector>

#include "palpate/fields/field.h"

namespace palpate {

/// For every field f_i of one image: max(f_i, max over j of (f_i - f_j) / 2). Negative where f_i is
/// negative and smallest; two neighbours' results are exact negatives of each other at their wall. Its structure
/// tells f_i and one smooth wall to each neighbor, which both share, so that contact holds their crease.
[[nodiscard]] std::vector<FieldPtr> shareLabels(const std::vector<FieldPtr>& fields);

}  // namespace palpate
