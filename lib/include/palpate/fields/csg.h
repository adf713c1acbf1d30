#pragma once
/// Boolean combinations. Values are min / max / negation of the operands' values: exact sign
/// everywhere, a bound on the distance if the operands are exact or bounds.
/// The operands stay visible through Field::structure(), so contact can hold each smooth leaf. Of many
/// exact operands only those near the point are asked, with the same result.

#include <vector>

#include "palpate/fields/field.h"

namespace palpate {

/// Inside any operand. @throws Error (kInput) if there is none, or one is null; same below.
[[nodiscard]] FieldPtr unite(std::vector<FieldPtr> operands);

/// Inside all operands.
[[nodiscard]] FieldPtr intersect(std::vector<FieldPtr> operands);

/// Inside the first and outside all the others: intersect(first, complement(second), ...).
[[nodiscard]] FieldPtr subtract(std::vector<FieldPtr> operands);

/// The object turned inside out: -S.
[[nodiscard]] FieldPtr complement(FieldPtr operand);

/// `whole`, an intersection of smooth solids with a value of its own, that shows `faces` as its
/// structure (kFaces): contact then holds each face, and edges and corners between them, exactly. One
/// face is a cheaper field of the same surface.
/// @throws Error (kInput) if there are no faces, or something is null.
[[nodiscard]] FieldPtr withFaces(FieldPtr whole, std::vector<FieldPtr> faces);

}  // namespace palpate
