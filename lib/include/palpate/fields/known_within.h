#pragma once
/// A field of which only a part is kept: what lies in a box.

#include "palpate/fields/field.h"

namespace palpate {

/// `field` within `box` [m]; beyond, what it is at the nearest point of the box. So it has one sign from the
/// box's face outwards, goes on without a step, and `field` is never asked out of the box (but with what is not finite).
/// One leaf. @throws Error (kInput) if `field` is null or `box` is empty.
[[nodiscard]] FieldPtr knownWithin(FieldPtr field, const Box3& box);

/// What knownWithin() was given; `field` itself if it was not made so.
[[nodiscard]] const Field& knownField(const Field& field) noexcept;

}  // namespace palpate
