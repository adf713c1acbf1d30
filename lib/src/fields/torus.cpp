#include <algorithm>

#include "fields/checks.h"
#include "fields/revolved.h"
#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"

namespace palpate {
namespace {

/// A disc of radius `tube` about (radius, 0).
struct TorusProfile {
  double radius = 0.0;
  double tube = 0.0;

  [[nodiscard]] fields::ProfileSample sample(double rho, double h) const noexcept {
    const fields::Polar2 q = fields::polar2(rho - radius, h);
    return {q.length - tube, q.a, q.b};
  }
  [[nodiscard]] fields::ProfileValue plain(double rho, double h) const noexcept {
    const double a = rho - radius;
    const double square = a * a + h * h;
    return {std::sqrt(square) - tube, square};
  }
  [[nodiscard]] fields::ProfileJet jet(double rho, double h) const noexcept {
    return fields::profileAround(sample(rho, h), fields::polar2(rho - radius, h));
  }
  [[nodiscard]] Box3 bounds(const Vec3& center, const Vec3& axis) const noexcept {
    const Vec3 extent = fields::discExtent(axis, radius) + Vec3(tube);
    return {center - extent, center + extent};
  }
  [[nodiscard]] double featureSize() const noexcept { return std::min(tube, radius - tube); }
};

/// A disc of `radius` swept along the axis from -half to half.
struct CapsuleProfile {
  double half = 0.0;
  double radius = 0.0;

  [[nodiscard]] fields::ProfileSample sample(double rho, double h) const noexcept {
    const fields::Polar2 q = fields::polar2(rho, beyond(h));
    return {q.length - radius, q.a, q.b};
  }
  [[nodiscard]] fields::ProfileValue plain(double rho, double h) const noexcept {
    const double below = h < -half ? -half : h;
    const double b = h - (below > half ? half : below);
    const double square = rho * rho + b * b;
    return {std::sqrt(square) - radius, square};
  }
  [[nodiscard]] fields::ProfileJet jet(double rho, double h) const noexcept {
    const fields::ProfileSample at = sample(rho, h);
    if (beyond(h) == 0.0) return {at};
    return fields::profileAround(at, fields::polar2(rho, beyond(h)));
  }
  [[nodiscard]] Box3 bounds(const Vec3& center, const Vec3& axis) const noexcept {
    const Vec3 extent = glm::abs(axis) * half + Vec3(radius);
    return {center - extent, center + extent};
  }
  [[nodiscard]] double featureSize() const noexcept { return radius; }

 private:
  [[nodiscard]] double beyond(double h) const noexcept { return h - std::clamp(h, -half, half); }
};

}  // namespace

FieldPtr torus(const Vec3& center, const Vec3& axis, double radius, double tube) {
  fields::checkPoint("torus", "center", center);
  const Vec3 unit = fields::checkedDirection("torus", "axis", axis);
  fields::checkLength("torus", "radius", radius);
  // If the tube's radius is closer to `radius` than this, the hole closes and the two walls no
  // longer bound a solid.
  fields::checkRange("torus", "tube", tube, fields::kSmallestLength, radius * (1.0 - 1e-6));
  return std::make_shared<fields::Revolved<TorusProfile>>(center, unit, TorusProfile{radius, tube});
}

FieldPtr capsule(const Vec3& from, const Vec3& to, double radius) {
  fields::checkPoint("capsule", "from", from);
  fields::checkPoint("capsule", "to", to);
  fields::checkLength("capsule", "radius", radius);
  const Vec3 unit = fields::checkedDirection("capsule", "to - from", to - from);
  return std::make_shared<fields::Revolved<CapsuleProfile>>(
      0.5 * (from + to), unit, CapsuleProfile{0.5 * glm::length(to - from), radius});
}

}  // namespace palpate
