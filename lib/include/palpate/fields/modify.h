#pragma once
/// Fields made from another field. All work through the CSG structure of the operand down to its
/// leaves, so that contact still sees those; the parts become fields of their own, which a port can
/// name only by the whole. @throws Error (kInput) if `field` is null, a number is out of range, or
/// `field` is a grid whose band ends nearer to its surface than an offset or shell reaches.

#include "palpate/fields/field.h"

namespace palpate {

/// `field` grown by `factor` (above 0) about the origin. Metric and Lipschitz bound are kept.
[[nodiscard]] FieldPtr scale(FieldPtr field, double factor);

/// The set where `field` is below `distance` [m]: grown if that is positive, shrunk if negative. A
/// bound for exact and bound fields. Of an exact field, the grown solid is the true one (rounded at
/// edges), outside also its distance.
[[nodiscard]] FieldPtr offset(FieldPtr field, double distance);

/// The wall of `thickness` [m] below the surface of `field`, which stays the outer one; what is
/// deeper is hollow.
[[nodiscard]] FieldPtr shell(FieldPtr field, double thickness);

}  // namespace palpate
