#pragma once
/// Whether a leaf is a convex solid.

#include "palpate/core/math.h"
#include "palpate/fields/field.h"

namespace palpate {

/// Whether `field` was convex at all of some hundred places in `around`, which are the same for
/// each call. True of balls, cylinders and cones; not of a torus, a saddle or a scan. For set-up.
[[nodiscard]] bool isConvex(const Field& field, const Box3& around);

}  // namespace palpate
