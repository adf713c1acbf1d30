#pragma once
/// Analytic solids. All lengths in [m], in the field's own frame. Every constructor function throws
/// Error (kInput) for a value that is not finite, or not positive where it must be.

#include "palpate/fields/field.h"

namespace palpate {

/// Everything on the side of `point` that `normal` points away from. Exact.
[[nodiscard]] FieldPtr halfSpace(const Vec3& point, const Vec3& normal);

/// Ball. Exact; the gradient at the centre is +x.
[[nodiscard]] FieldPtr sphere(const Vec3& center, double radius);

/// Axis-aligned box with full edge lengths `size`. Exact, inside and out.
[[nodiscard]] FieldPtr box(const Vec3& center, const Vec3& size);

/// Solid cylinder: `center` is the middle of its axis, `height` its full length, capped flat. Exact.
[[nodiscard]] FieldPtr cylinder(const Vec3& center, const Vec3& axis, double radius, double height);

/// Ellipsoid with semi-axes `radii` along x, y, z. Exact Euclidean distance (Newton on the
/// closest-point equation; D. Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a
/// Hyperellipsoid", 2013).
[[nodiscard]] FieldPtr ellipsoid(const Vec3& center, const Vec3& radii);

}  // namespace palpate
