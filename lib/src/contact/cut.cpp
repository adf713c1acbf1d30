#include "palpate/contact/cut.h"

#include <algorithm>

namespace palpate {

Vec3 Cut::step(const Vec3& tip, double stiffness, double cutting_force) noexcept {
  if (!(stiffness > 0.0)) return Vec3(0.0);
  const Vec3 way = end_ - entry_;
  const double length = glm::length(way);
  const double along = length > 0.0 ? glm::dot(tip - entry_, way) / length : 0.0;
  // Before the entry it goes on as it began: the shaft was there.
  const double share = length > 0.0 ? std::min(along / length, 1.0) : 1.0;
  const Vec3 near = share < 1.0 ? entry_ + share * way : end_;
  const Vec3 press = tip - near;
  const double depth = glm::length(press);
  const double most = std::max(cutting_force, 0.0) / stiffness;
  if (depth <= most) return -stiffness * press;

  const Vec3 direction = press / depth;
  if (share < 0.0) return -stiffness * most * direction;
  const Vec3 torn = tip - most * direction;
  // The end moves on with the tip; a side takes the whole straight cut along, about where it was entered.
  end_ = share < 1.0 ? entry_ + length * unitOr(torn - entry_, way / length) : torn;
  return -stiffness * most * direction;
}

}  // namespace palpate
