#pragma once
/// Fields made from other fields: Boolean combinations, with and without creases, placements,
/// fields grown, shrunk and hollowed, and fields restricted to a box.

#include <vector>

#include "palpate/export.h"
#include "palpate/fields/field.h"

namespace palpate {

/// The union: the points inside any operand. @throws Error (kInput) if `operands` is empty or
/// contains null; the same holds for the functions below.
[[nodiscard]] PALPATE_EXPORT FieldPtr unite(std::vector<FieldPtr> operands);

/// The intersection: the points inside all operands.
[[nodiscard]] PALPATE_EXPORT FieldPtr intersect(std::vector<FieldPtr> operands);

/// The difference of the first and all the others: intersect(first, complement(second), ...).
[[nodiscard]] PALPATE_EXPORT FieldPtr subtract(std::vector<FieldPtr> operands);

/// The object turned inside out: -S.
[[nodiscard]] PALPATE_EXPORT FieldPtr complement(FieldPtr operand);

/// `whole`, an intersection of smooth solids whose value is better than their max, with `faces` as
/// its structure (kFaces): contact then holds each face, and the edges and corners between them,
/// exactly. With one face it is a cheaper field of the same surface. @throws Error (kInput) if
/// there are no faces, or any argument is null.
[[nodiscard]] PALPATE_EXPORT FieldPtr withFaces(FieldPtr whole, std::vector<FieldPtr> faces);

// Boolean combinations with a smooth transition (C2) instead of a crease. Where the operands'
// values differ by `radius` [m] or more, they are the plain min and max; where they are equal, the
// value is moved by radius / 6. The Lipschitz bound of the operands is kept, so a blend of fields
// whose metric is kExact or kBound has the metric kBound. A blend is one leaf: no port can name its
// operands.
//
// With more than two operands the order matters slightly: they are combined one after the other,
// starting with the first.
// @throws Error (kInput) if there is no operand, one is null or a grid whose band ends nearer than
// `radius` to its surface, or `radius` is not a positive length; this holds for all three
// functions.

/// Union; the crease between the operands is filled.
[[nodiscard]] PALPATE_EXPORT FieldPtr smoothUnite(std::vector<FieldPtr> operands, double radius);

/// Intersection; the edge between the operands is rounded off.
[[nodiscard]] PALPATE_EXPORT FieldPtr smoothIntersect(std::vector<FieldPtr> operands,
                                                      double radius);

/// Inside the first and outside all the others; the edges between them are rounded off.
[[nodiscard]] PALPATE_EXPORT FieldPtr smoothSubtract(std::vector<FieldPtr> operands, double radius);

// Rigid placement of a field. Metric, Lipschitz bound and feature size are kept.

/// `field` moved by `pose` (field frame -> frame of the result). @throws Error (kInput) if `field`
/// is null or `pose` is not finite and rigid (rotation orthonormal to 1e-9, determinant +1).
[[nodiscard]] PALPATE_EXPORT FieldPtr place(FieldPtr field, const Pose& pose);

// Fields made from another field. All are applied through the CSG structure of the operand to each
// of its leaves, so that contact still sees the leaves. The changed leaves are new fields: a port
// can name only the whole result, not one of them. @throws Error (kInput) if `field` is null, a
// number is out of range, or `field` is a grid whose band ends nearer to its surface than an offset
// or shell reaches.

/// `field` grown by `factor` (above 0) about the origin. Metric and Lipschitz bound are kept.
[[nodiscard]] PALPATE_EXPORT FieldPtr scale(FieldPtr field, double factor);

/// The set where `field` is below `distance` [m]: grown if `distance` is positive, shrunk if
/// negative. The metric is kBound for exact and bound fields. If `field` is exact, the grown solid
/// is the true one (rounded at edges), and outside it the value is the distance to it.
[[nodiscard]] PALPATE_EXPORT FieldPtr offset(FieldPtr field, double distance);

/// The layer of `thickness` [m] below the surface of `field`, which stays the outer surface;
/// everything deeper is hollow.
[[nodiscard]] PALPATE_EXPORT FieldPtr shell(FieldPtr field, double thickness);

// A field that is restricted to a box.

/// `field` within `box` [m]; at a point beyond the box, the value that `field` has at the nearest
/// point of the box. So the sign stays the same from the box's face outwards, the value is
/// continuous, and `field` is never evaluated outside the box (except at points that are not
/// finite). One leaf. @throws Error (kInput) if `field` is null or `box` is empty.
[[nodiscard]] PALPATE_EXPORT FieldPtr knownWithin(FieldPtr field, const Box3& box);

/// The field that knownWithin() was given; `field` itself if it was not made by knownWithin().
[[nodiscard]] PALPATE_EXPORT const Field& knownField(const Field& field) noexcept;

}  // namespace palpate
