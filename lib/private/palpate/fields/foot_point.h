#pragma once
/// The nearest point of a field's surface, for fields whose value is not a distance.

#include <optional>

#include "palpate/fields/field.h"

namespace palpate {

struct FootPoint {
  Vec3 point{0.0, 0.0, 0.0};   ///< [m] on the surface
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] unit, outward, there
  double distance = 0.0;       ///< [m] of the given point from the surface, negative inside
  /// [1/m] sum and product of the surface's principal curvatures there; positive where convex.
  double curvature_sum = 0.0;
  double curvature_product = 0.0;
};

/// Newton's method on the conditions of the nearest point: x - p + lambda grad S(x) = 0 and S(x) =
/// 0. For set-up and measurement: it takes some ten evaluations and 14 values, but does not
/// allocate, and may run on any thread. No value if it does not converge to rounding, if the foot
/// is not a nearest point (p lies beyond the center of curvature), or if another part of the
/// surface is nearer. The last is tested on the sphere around p that reaches almost to the foot:
/// there the field must have the sign that it has at p. The field must be twice differentiable
/// between p and its foot.
[[nodiscard]] std::optional<FootPoint> footPoint(const Field& field, const Vec3& p) noexcept;

}  // namespace palpate
