#pragma once
/// Boolean combinations with a smooth transition (C2) instead of a crease. Where the operands' values
/// differ by `radius` [m] or more, they are the plain min and max; where they are equal, the value is
/// moved by radius / 6. The Lipschitz bound of the operands is kept, so blends of exact and bound
/// fields are bounds. A blend is one leaf: no port can name its operands.
///
/// With more than two operands the order matters slightly: they are combined from the first on.
/// @throws Error (kInput) if there is no operand, one is null or a grid whose band ends nearer than
/// `radius` to its surface, or `radius` is no length; all three.

#include <vector>

#include "palpate/fields/field.h"

namespace palpate {

/// Fills the crease between the operands.
[[nodiscard]] FieldPtr smoothUnite(std::vector<FieldPtr> operands, double radius);

/// Takes off the edge between the operands.
[[nodiscard]] FieldPtr smoothIntersect(std::vector<FieldPtr> operands, double radius);

/// Inside the first and outside all the others, edges taken off.
[[nodiscard]] FieldPtr smoothSubtract(std::vector<FieldPtr> operands, double radius);

}  // namespace palpate
