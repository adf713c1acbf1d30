#pragma once
// An ellipsoid whose value is not a distance.

#include "palpate/fields/implicit.h"

namespace palpate::testing {

/// The polynomial (x / a)^2 + (y / b)^2 + (z / c)^2 - 1 about `center`. ellipsoid() gives the
/// distance to the same surface, by another method.
[[nodiscard]] inline FieldPtr implicitEllipsoid(const Vec3& center, const Vec3& radii) {
  QuadricCoefficients c;
  c.xx = 1.0 / (radii.x * radii.x);
  c.yy = 1.0 / (radii.y * radii.y);
  c.zz = 1.0 / (radii.z * radii.z);
  c.constant = -1.0;
  return quadric(center, c);
}

}  // namespace palpate::testing
