// A part that decides nothing where the hand is has no part in what it feels: the planes of its faces end where
// it does.

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

/// 1e-6 of 2 mm, and two walls' billionth of their feature sizes.
constexpr double kClose = 2.5e-9;  // [m]

/// A hand within a ball of radius `ball` [m], pressed 2 mm into the wall of a bore of 6 mm, around it and along it.
void circleBore(const FieldPtr& far_part, double ball) {
  const FieldPtr bore = cylinder(Vec3(0.0), Vec3(0, 0, 1), 0.003, 0.060);
  std::vector<FieldPtr> parts = {sphere(Vec3(0.0), ball), bore};
  if (far_part) parts.push_back(far_part);
  Drive drive(sceneOfSolid(subtract(parts), true));
  (void)drive.to(mm(8, 0, 0));
  (void)drive.walk(mm(3.5, 0, 0), 1e-4);
  double worst = 0.0;
  double worst_force = 0.0;
  Vec3 last_force(0.0);
  double largest_step = 0.0;
  constexpr int kTicks = 6000;
  for (int i = 0; i < kTicks; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / 1500.0;
    const Vec3 u(std::cos(turn), std::sin(turn), 0.0);
    const double pressed = std::min(0.002, 1e-6 * i);  // all that while going around
    const Vec3 p = (0.003 - pressed) * u + Vec3(0, 0, 0.004 * std::sin(0.37 * turn));
    const Vec3 right = 0.003 * u + Vec3(0, 0, p.z);
    const TickResult& out = drive.to(p);
    worst = std::max(worst, glm::length(out.proxy - right));
    worst_force = std::max(worst_force, glm::length(out.force - kDefaultK * (right - p)));
    if (i > 0) largest_step = std::max(largest_step, glm::length(out.force - last_force));
    last_force = out.force;
  }
  EXPECT_LE(worst, kClose);
  EXPECT_LE(worst_force, kDefaultK * kClose);
  // 2 N turn by 1 / 1500 of a circle a tick, and z goes by up to 6 um.
  EXPECT_LE(largest_step, 2.0 * 2.0 * std::numbers::pi / 1500.0 + 7e-3);
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
  // Their planes are tangent to the wall of the bore.
  circleBore(box(mm(0, 60, 0), mm(6, 5, 5)), 0.1);
}

TEST(PhantomPlanes, OfAConeThatPointsHere) {
  circleBore(cone(mm(0, 60, 0), Vec3(0, -1, 0), 0.004, 0.010), 0.1);
}

}  // namespace
}  // namespace palpate::test
