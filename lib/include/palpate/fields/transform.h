#pragma once
/// Rigid placement of a field. Metric, Lipschitz bound and feature size are kept.

#include "palpate/fields/field.h"

namespace palpate {

/// `field` moved by `pose` (field frame -> frame of the result). @throws Error (kInput) if `field` is
/// null or `pose` is not finite and rigid (rotation orthonormal to 1e-9, determinant +1).
[[nodiscard]] FieldPtr place(FieldPtr field, const Pose& pose);

}  // namespace palpate
