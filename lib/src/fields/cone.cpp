#include <algorithm>

#include "fields/checks.h"
#include "fields/revolved.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate {
namespace {

/// A right triangle: the base on h = 0 from the axis to the rim at `radius`, the tip at (0,
/// height). If it has no base it extends downward without end.
struct ConeProfile {
  double radius = 0.0;
  double height = 0.0;
  bool has_base = true;

  struct Nearest {
    fields::ProfileSample at;
    fields::Polar2 from_corner{0.0, 1.0, 0.0};
    bool is_corner = false;  ///< the nearest feature is the rim or the tip
  };

  [[nodiscard]] Nearest nearest(double rho, double h) const noexcept {
    const double slant = std::sqrt(radius * radius + height * height);
    const double down = radius / slant;  // the slant line from rim to tip runs along (-down, up)
    const double up = height / slant;
    const double out = rho - radius;
    const double along = h * up - out * down;
    if (along > slant) return corner(rho, h - height);
    if (has_base && h <= 0.0 && rho <= radius) return {{-h, 0.0, -1.0}};
    if (has_base && (h <= 0.0 || along < 0.0)) return corner(out, h);
    const double across = out * up + h * down;
    if (has_base && -h > across) return {{-h, 0.0, -1.0}};
    return {{across, up, down}};
  }

  [[nodiscard]] fields::ProfileSample sample(double rho, double h) const noexcept {
    return nearest(rho, h).at;
  }
  [[nodiscard]] fields::ProfileValue plain(double rho, double h) const noexcept {
    return {sample(rho, h).value};
  }
  [[nodiscard]] fields::ProfileJet jet(double rho, double h) const noexcept {
    const Nearest n = nearest(rho, h);
    return n.is_corner ? fields::profileAround(n.at, n.from_corner) : fields::ProfileJet{n.at};
  }
  [[nodiscard]] Box3 bounds(const Vec3& base, const Vec3& axis) const noexcept {
    if (!has_base) return Box3::everything();
    const Vec3 extent = fields::discExtent(axis, radius);
    Box3 box{base - extent, base + extent};
    box.include(base + height * axis);
    return box;
  }
  [[nodiscard]] double featureSize() const noexcept { return std::min(radius, height); }

 private:
  static Nearest corner(double rho, double h) noexcept {
    const fields::Polar2 q = fields::polar2(rho, h);
    return {{q.length, q.a, q.b}, q, true};
  }
};

}  // namespace

FieldPtr cone(const Vec3& base, const Vec3& axis, double radius, double height) {
  fields::checkPoint("cone", "base", base);
  const Vec3 unit = fields::checkedDirection("cone", "axis", axis);
  fields::checkLength("cone", "radius", radius);
  fields::checkLength("cone", "height", height);
  using Cone = fields::Revolved<ConeProfile>;
  return withFaces(std::make_shared<Cone>(base, unit, ConeProfile{radius, height, true}),
                   {std::make_shared<Cone>(base, unit, ConeProfile{radius, height, false}),
                    halfSpace(base, -unit)});
}

}  // namespace palpate
