#include "palpate/contact/cut.h"

#include <algorithm>

namespace palpate {

Cut::Near Cut::nearest(const Vec3& tip) const noexcept {
  Near near;
  near.way = end_ - entry_;
  near.length = glm::length(near.way);
  const double along = near.length > 0.0 ? glm::dot(tip - entry_, near.way) / near.length : 0.0;
  // Before the entry the cut is taken to continue straight backward, since the shaft lay there.
  near.share = near.length > 0.0 ? std::min(along / near.length, 1.0) : 1.0;
  near.point = near.share < 1.0 ? entry_ + near.share * near.way : end_;
  return near;
}

/// The end moves on with the tip. If the side of the cut tears instead, the whole straight cut
/// turns about its entry.
void Cut::moveTo(const Near& near, const Vec3& torn) noexcept {
  end_ = near.share < 1.0 ? entry_ + near.length * unitOr(torn - entry_, near.way / near.length)
                          : torn;
}

Vec3 Cut::step(const Vec3& tip, double stiffness, double cutting_force) noexcept {
  if (!(stiffness > 0.0)) return Vec3(0.0);
  const Near near = nearest(tip);
  const Vec3 press = tip - near.point;
  const double depth = glm::length(press);
  const double most = std::max(cutting_force, 0.0) / stiffness;
  if (depth <= most) return -stiffness * press;

  const Vec3 direction = press / depth;
  if (near.share < 0.0) return -stiffness * most * direction;
  moveTo(near, tip - most * direction);
  return -stiffness * most * direction;
}

void Cut::restOn(const Vec3& tip, std::span<const HeldWall> rests_on) noexcept {
  if (rests_on.empty()) return;
  const Near near = nearest(tip);
  if (near.share < 0.0) return;
  moveTo(near, tip - tangentialPart(tip - near.point, rests_on));
}

}  // namespace palpate
