#pragma once
/// Analytic solids. All lengths in [m], in the field's own frame. Every constructor function throws
/// Error (kInput) for a value that is not finite, or not positive where it must be.

#include "palpate/export.h"
#include "palpate/fields/field.h"

namespace palpate {

/// Everything on the side of `point` that `normal` points away from. Exact.
[[nodiscard]] PALPATE_EXPORT FieldPtr halfSpace(const Vec3& point, const Vec3& normal);

/// Ball. Exact; the gradient at the center is +x.
[[nodiscard]] PALPATE_EXPORT FieldPtr sphere(const Vec3& center, double radius);

/// Axis-aligned box with full edge lengths `size`. Exact, inside and out.
[[nodiscard]] PALPATE_EXPORT FieldPtr box(const Vec3& center, const Vec3& size);

/// Solid cylinder: `center` is the middle of its axis, `height` its full length; its ends are flat.
/// Exact.
[[nodiscard]] PALPATE_EXPORT FieldPtr cylinder(const Vec3& center, const Vec3& axis, double radius,
                                               double height);

/// Ellipsoid with semi-axes `radii` along x, y, z. Exact Euclidean distance (Newton on the
/// closest-point equation; D. Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a
/// Hyperellipsoid", 2013).
[[nodiscard]] PALPATE_EXPORT FieldPtr ellipsoid(const Vec3& center, const Vec3& radii);

/// Box whose edges and corners are rounded with the radius `rounding`, at most half its smallest
/// size; `size` stays its outer size. Exact; smooth (C1), so one leaf.
[[nodiscard]] PALPATE_EXPORT FieldPtr roundedBox(const Vec3& center, const Vec3& size,
                                                 double rounding);

/// Cone over the disc of `radius` around `base`, its tip at base + height * axis / |axis|. Exact.
[[nodiscard]] PALPATE_EXPORT FieldPtr cone(const Vec3& base, const Vec3& axis, double radius,
                                           double height);

/// Ring: a tube of radius `tube` around the circle of `radius` about `center` in the plane normal
/// to `axis`; tube < radius. Exact.
[[nodiscard]] PALPATE_EXPORT FieldPtr torus(const Vec3& center, const Vec3& axis, double radius,
                                            double tube);

/// All points nearer than `radius` to the segment between two different points. Exact.
[[nodiscard]] PALPATE_EXPORT FieldPtr capsule(const Vec3& from, const Vec3& to, double radius);

}  // namespace palpate
