#include <algorithm>

#include "fields/checks.h"
#include "fields/revolved.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate {
namespace {

/// A rectangle: the wall at `radius`, the caps at +-`half_height`.
struct CylinderProfile {
  double radius = 0.0;
  double half_height = 0.0;

  [[nodiscard]] fields::ProfileSample sample(double rho, double height) const noexcept {
    const double up = fields::side(height);
    const double beyond_wall = rho - radius;
    const double beyond_cap = std::fabs(height) - half_height;
    if (beyond_cap > 0.0 && beyond_wall > 0.0) {
      const fields::Polar2 q = fields::polar2(beyond_wall, beyond_cap);
      return {q.length, q.a, q.b * up};
    }
    if (beyond_cap > beyond_wall) return {beyond_cap, 0.0, up};
    return {beyond_wall, 1.0, 0.0};
  }
  [[nodiscard]] fields::ProfileValue plain(double rho, double height) const noexcept {
    const double beyond_wall = rho - radius;
    const double beyond_cap = std::fabs(height) - half_height;
    const double nearer = beyond_cap > beyond_wall ? beyond_cap : beyond_wall;
    const double square = beyond_wall * beyond_wall + beyond_cap * beyond_cap;
    const double away = std::sqrt(square);
    const bool is_beyond_rim = (beyond_cap > 0.0) & (beyond_wall > 0.0);
    return {is_beyond_rim ? away : nearer, is_beyond_rim ? square : 1.0};
  }

  [[nodiscard]] fields::ProfileJet jet(double rho, double height) const noexcept {
    const fields::ProfileSample at = sample(rho, height);
    const double beyond_wall = rho - radius;
    const double beyond_cap = std::fabs(height) - half_height;
    if (!(beyond_cap > 0.0 && beyond_wall > 0.0)) return {at};
    return fields::profileAround(at, {at.value, at.by_rho, at.by_height});
  }

  [[nodiscard]] Box3 bounds(const Vec3& center, const Vec3& axis) const noexcept {
    const Vec3 extent = fields::discExtent(axis, radius) + glm::abs(axis) * half_height;
    return {center - extent, center + extent};
  }

  [[nodiscard]] double featureSize() const noexcept { return std::min(radius, 2.0 * half_height); }
};

/// The curved wall alone, infinitely long.
struct TubeProfile {
  double radius = 0.0;

  [[nodiscard]] fields::ProfileSample sample(double rho, double) const noexcept {
    return {rho - radius, 1.0, 0.0};
  }
  [[nodiscard]] fields::ProfileValue plain(double rho, double) const noexcept {
    return {rho - radius};
  }
  [[nodiscard]] fields::ProfileJet jet(double rho, double height) const noexcept {
    return {sample(rho, height)};
  }
  [[nodiscard]] Box3 bounds(const Vec3&, const Vec3&) const noexcept { return Box3::everything(); }
  [[nodiscard]] double featureSize() const noexcept { return radius; }
};

}  // namespace

FieldPtr cylinder(const Vec3& center, const Vec3& axis, double radius, double height) {
  fields::checkPoint("cylinder", "center", center);
  const Vec3 unit = fields::checkedDirection("cylinder", "axis", axis);
  fields::checkLength("cylinder", "radius", radius);
  fields::checkLength("cylinder", "height", height);
  const Vec3 up = 0.5 * height * unit;
  return withFaces(
      std::make_shared<fields::Revolved<CylinderProfile>>(center, unit,
                                                          CylinderProfile{radius, 0.5 * height}),
      {std::make_shared<fields::Revolved<TubeProfile>>(center, unit, TubeProfile{radius}),
       halfSpace(center + up, unit), halfSpace(center - up, -unit)});
}

}  // namespace palpate
