#pragma once
/// Whether a leaf is hollow all over, seen from within.

#include "palpate/core/math.h"
#include "palpate/fields/field.h"

namespace palpate {

/// Whether `field` bends outward wherever it was looked at: at some hundred places in `around`,
/// which are the same for each call. True of balls, cylinders and cones; not of a torus, a saddle
/// or a scan. For set-up.
[[nodiscard]] bool isConvex(const Field& field, const Box3& around);

}  // namespace palpate
