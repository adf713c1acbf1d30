#pragma once
/// Fields made from other fields: Boolean combinations, with and without creases, placements,
/// fields grown, shrunk and hollowed, and fields of which only a part is kept.

#include <vector>

#include "palpate/export.h"
#include "palpate/fields/field.h"

namespace palpate {

/// Inside any operand. @throws Error (kInput) if there is none, or one is null; same below.
[[nodiscard]] PALPATE_EXPORT FieldPtr unite(std::vector<FieldPtr> operands);

/// Inside all operands.
[[nodiscard]] PALPATE_EXPORT FieldPtr intersect(std::vector<FieldPtr> operands);

/// Inside the first and outside all the others: intersect(first, complement(second), ...).
[[nodiscard]] PALPATE_EXPORT FieldPtr subtract(std::vector<FieldPtr> operands);

/// The object turned inside out: -S.
[[nodiscard]] PALPATE_EXPORT FieldPtr complement(FieldPtr operand);

/// `whole`, an intersection of smooth solids with a value of its own, that shows `faces` as its
/// structure (kFaces): contact then holds each face, and edges and corners between them, exactly.
/// One face is a cheaper field of the same surface.
/// @throws Error (kInput) if there are no faces, or something is null.
[[nodiscard]] PALPATE_EXPORT FieldPtr withFaces(FieldPtr whole, std::vector<FieldPtr> faces);

// Boolean combinations with a smooth transition (C2) instead of a crease. Where the operands'
// values differ by `radius` [m] or more, they are the plain min and max; where they are equal, the
// value is moved by radius / 6. The Lipschitz bound of the operands is kept, so blends of exact and
// bound fields are bounds. A blend is one leaf: no port can name its operands.
//
// With more than two operands the order matters slightly: they are combined from the first on.
// @throws Error (kInput) if there is no operand, one is null or a grid whose band ends nearer than
// `radius` to its surface, or `radius` is not a length; all three.

/// Fills the crease between the operands.
[[nodiscard]] PALPATE_EXPORT FieldPtr smoothUnite(std::vector<FieldPtr> operands, double radius);

/// Takes off the edge between the operands.
[[nodiscard]] PALPATE_EXPORT FieldPtr smoothIntersect(std::vector<FieldPtr> operands,
                                                      double radius);

/// Inside the first and outside all the others, edges taken off.
[[nodiscard]] PALPATE_EXPORT FieldPtr smoothSubtract(std::vector<FieldPtr> operands, double radius);

// Rigid placement of a field. Metric, Lipschitz bound and feature size are kept.

/// `field` moved by `pose` (field frame -> frame of the result). @throws Error (kInput) if `field`
/// is null or `pose` is not finite and rigid (rotation orthonormal to 1e-9, determinant +1).
[[nodiscard]] PALPATE_EXPORT FieldPtr place(FieldPtr field, const Pose& pose);

// Fields made from another field. All work through the CSG structure of the operand down to its
// leaves, so that contact still sees those; the parts become fields of their own, which a port can
// name only by the whole. @throws Error (kInput) if `field` is null, a number is out of range, or
// `field` is a grid whose band ends nearer to its surface than an offset or shell reaches.

/// `field` grown by `factor` (above 0) about the origin. Metric and Lipschitz bound are kept.
[[nodiscard]] PALPATE_EXPORT FieldPtr scale(FieldPtr field, double factor);

/// The set where `field` is below `distance` [m]: grown if that is positive, shrunk if negative. A
/// bound for exact and bound fields. Of an exact field, the grown solid is the true one (rounded at
/// edges), outside also its distance.
[[nodiscard]] PALPATE_EXPORT FieldPtr offset(FieldPtr field, double distance);

/// The wall of `thickness` [m] below the surface of `field`, which stays the outer one; what is
/// deeper is hollow.
[[nodiscard]] PALPATE_EXPORT FieldPtr shell(FieldPtr field, double thickness);

// A field of which only a part is kept: what lies in a box.

/// `field` within `box` [m]; beyond, what it is at the nearest point of the box. So it has one sign
/// from the box's face outwards, goes on without a step, and `field` is never asked out of the box
/// (but with what is not finite). One leaf. @throws Error (kInput) if `field` is null or `box` is
/// empty.
[[nodiscard]] PALPATE_EXPORT FieldPtr knownWithin(FieldPtr field, const Box3& box);

/// What knownWithin() was given; `field` itself if it was not made so.
[[nodiscard]] PALPATE_EXPORT const Field& knownField(const Field& field) noexcept;

}  // namespace palpate
