#include "palpate/core/math.h"

#include <algorithm>

namespace palpate {

Box3 Box3::unitedWith(const Box3& other) const noexcept {
  return {glm::min(lo, other.lo), glm::max(hi, other.hi)};
}

Box3 Box3::intersectedWith(const Box3& other) const noexcept {
  return {glm::max(lo, other.lo), glm::min(hi, other.hi)};
}

Box3 Box3::grownBy(double margin) const noexcept {
  if (isEmpty()) return *this;
  return {lo - Vec3(margin), hi + Vec3(margin)};
}

double Box3::distanceTo(const Vec3& p) const noexcept {
  const Vec3 outside = glm::max(glm::max(lo - p, p - hi), Vec3(0.0));
  return glm::length(outside);
}

Box3 Pose::apply(const Box3& box) const noexcept {
  if (box.isEmpty()) return box;
  // Each output coordinate is a sum of independent interval products; 0 * infinity counts as 0.
  Box3 out{translation, translation};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double factor = rotation[column][row];
      if (factor == 0.0) continue;
      const double a = factor * box.lo[column];
      const double b = factor * box.hi[column];
      out.lo[row] += std::min(a, b);
      out.hi[row] += std::max(a, b);
    }
  }
  return out;
}

Mat3 rotationAbout(const Vec3& axis, double radians) noexcept {
  const Vec3 u = unitOr(axis, Vec3(0.0, 0.0, 1.0));
  const double c = std::cos(radians);
  const double s = std::sin(radians);
  Mat3 cross(0.0);  // the matrix with cross * v = u x v
  cross[1][0] = -u.z;
  cross[2][0] = u.y;
  cross[0][1] = u.z;
  cross[2][1] = -u.x;
  cross[0][2] = -u.y;
  cross[1][2] = u.x;
  return Mat3(c) + (1.0 - c) * outer(u, u) + s * cross;
}

}  // namespace palpate
