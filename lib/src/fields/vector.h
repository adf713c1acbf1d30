#pragma once
/// Lengths and directions that neither overflow nor underflow for finite vectors. Private to
/// fields.

#include "palpate/core/math.h"

namespace palpate::fields {

struct Polar {
  double length = 0.0;            ///< [m]
  Vec3 direction{0.0, 0.0, 0.0};  ///< unit vector
};

/// polar() for vectors whose square leaves the range of double, or that are zero or not finite.
[[nodiscard]] Polar polarScaled(const Vec3& v, const Vec3& fallback) noexcept;
[[nodiscard]] double lengthScaled(const Vec3& v) noexcept;

/// Whether the square is in the range where the plain formula keeps every digit.
[[nodiscard]] inline bool isPlainSquare(double square) noexcept {
  return square > 1e-280 && square < 1e300;
}

/// Length and direction of `v`; `fallback` (a unit vector) is the direction of the zero vector.
[[nodiscard]] inline Polar polar(const Vec3& v, const Vec3& fallback) noexcept {
  const double square = glm::dot(v, v);
  if (!isPlainSquare(square)) [[unlikely]]
    return polarScaled(v, fallback);
  const double length = std::sqrt(square);
  return {length, v * (1.0 / length)};
}

/// The same length as polar(), bit for bit.
[[nodiscard]] inline double length(const Vec3& v) noexcept {
  const double square = glm::dot(v, v);
  if (!isPlainSquare(square)) [[unlikely]]
    return lengthScaled(v);
  return std::sqrt(square);
}

/// Some unit vector perpendicular to the unit vector `n`.
[[nodiscard]] Vec3 perpendicularTo(const Vec3& n) noexcept;

/// Hessian of a distance from a point, `distance` away along `direction`. Zero at the point itself,
/// where it has no limit.
[[nodiscard]] inline Mat3 radialHessian(const Vec3& direction, double distance) noexcept {
  if (!(distance > 1e-100)) return Mat3(0.0);
  return (Mat3(1.0) - outer(direction, direction)) * (1.0 / distance);
}

/// -1 below zero, +1 otherwise: -0.0 counts as +0.0, so that both zeros give the same gradient.
[[nodiscard]] inline double side(double x) noexcept { return x < 0.0 ? -1.0 : 1.0; }

}  // namespace palpate::fields
