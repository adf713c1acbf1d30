// A part of a solid that decides nothing where the hand is has no effect on the force: the planes
// of its faces end where the faces do.

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

/// 1e-6 of 2 mm, plus a billionth of two walls' feature sizes.
constexpr double kClose = 2.5e-9;  // [m]

/// A hand inside a ball of radius `ball` [m], pressed up to 2 mm into the wall of a bore of
/// `radius` [m], moving around the bore and along it.
void circleOneBore(const FieldPtr& far_part, double ball, double radius, int steps_around) {
  SCOPED_TRACE(::testing::Message() << "bore of radius " << radius << ", " << steps_around);
  const FieldPtr bore = cylinder(Vec3(0.0), Vec3(0, 0, 1), radius, 0.060);
  std::vector<FieldPtr> parts = {sphere(Vec3(0.0), ball), bore};
  if (far_part) parts.push_back(far_part);
  Drive drive(sceneOfSolid(subtract(parts), true));
  (void)drive.to(mm(12, 0, 0));
  (void)drive.walk({radius + 0.5e-3, 0, 0}, 1e-4);
  double worst = 0.0;
  double worst_force = 0.0;
  Vec3 last_force(0.0);
  double largest_step = 0.0;
  const int ticks = 4 * steps_around;
  for (int i = 0; i < ticks; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / steps_around;
    const Vec3 u(std::cos(turn), std::sin(turn), 0.0);
    const double pressed = std::min(0.002, 0.004 * i / ticks);  // growing while it goes around
    const Vec3 p = (radius - pressed) * u + Vec3(0, 0, 0.004 * std::sin(0.37 * turn));
    const Vec3 right = radius * u + Vec3(0, 0, p.z);
    const TickResult& out = drive.to(p);
    worst = std::max(worst, glm::length(out.proxy - right));
    worst_force = std::max(worst_force, glm::length(out.force - kDefaultK * (right - p)));
    if (i > 0) largest_step = std::max(largest_step, glm::length(out.force - last_force));
    last_force = out.force;
  }
  EXPECT_LE(worst, kClose);
  EXPECT_LE(worst_force, kDefaultK * kClose);
  // A force of 2 N turns by its share of a circle in a tick, and the press grows by 4 N in total.
  EXPECT_LE(largest_step, 2.0 * 2.0 * std::numbers::pi / steps_around + 5.0 / ticks);
}

void circleBore(const FieldPtr& far_part, double ball) {
  for (const double radius : {0.003, 0.006}) {
    for (const int steps : {500, 1500, 10'000}) circleOneBore(far_part, ball, radius, steps);
  }
}

TEST(PhantomPlanes, ABoreAlone) { circleBore(nullptr, 0.1); }

TEST(PhantomPlanes, OfABoxSixtyMillimetersAway) {
  circleBore(box(mm(0, 60, 0), Vec3(0.005)), 0.1);
  circleBore(box(mm(60, 0, 0), Vec3(0.005)), 0.1);
  circleBore(box(mm(1, 2, 60), Vec3(0.005)), 0.1);
}

TEST(PhantomPlanes, OfABoxTwoMetersAway) {
  circleBore(box(Vec3(0, 2, 0), Vec3(0.005)), 3.0);
  circleBore(box(Vec3(2, 0.001, 0), Vec3(0.005)), 3.0);
}

TEST(PhantomPlanes, OfABoxWhoseFacesTouchTheBore) {
  // The planes of two faces are tangent to the wall of the bore of 3 mm radius.
  circleBore(box(mm(0, 60, 0), mm(6, 5, 5)), 0.1);
}

TEST(PhantomPlanes, OfAConeThatPointsHere) {
  circleBore(cone(mm(0, 60, 0), Vec3(0, -1, 0), 0.004, 0.010), 0.1);
}

}  // namespace
}  // namespace palpate::test
