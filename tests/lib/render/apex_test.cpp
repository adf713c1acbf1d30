// Apexes from inside, and countersinks: the proxy is at the tip, and the force is that of a proxy
// there.

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/sanitized.h"

namespace palpate::test {
namespace {

/// A place of the hand, beyond the tip, for which the tip is nearest: within the cone of the tip's
/// normals, whose half angle is 90 degrees minus the cone's own.
Vec3 beyondTip(Random& random, double height, double half_angle, double depth) {
  const double most = 0.95 * (0.5 * std::numbers::pi - half_angle);
  const double lean = random.uniform(0.0, most);
  const double turn = random.uniform(0.0, 2.0 * std::numbers::pi);
  return Vec3(0, 0, height) + depth * Vec3(std::sin(lean) * std::cos(turn),
                                           std::sin(lean) * std::sin(turn), std::cos(lean));
}

/// A hand that moves around beyond the tip; every force is K (tip - P).
void feelTip(const ScenePtr& scene, const Vec3& free, double height, double half_angle,
             std::uint64_t seed) {
  Drive drive(scene);
  (void)drive.to(free);
  (void)drive.walk(Vec3(0, 0, height + 0.5e-3));
  const Vec3 tip(0, 0, height);
  Random random(seed);
  Vec3 goal = beyondTip(random, height, half_angle, 2e-3);
  int wrong_proxy = 0;
  int wrong_force = 0;
  int without_contact = 0;
  double worst = 0.0;
  constexpr int kGoTicks = 3000;
  for (int i = 0; i < kGoTicks; ++i) {
    const Vec3 way = goal - drive.hip();
    if (glm::length(way) < 1e-4) {
      goal = beyondTip(random, height, half_angle, random.uniform(0.2e-3, 2.5e-3));
    }
    // The cone of normals is convex, so every place between two goals is in it.
    const Vec3 p = drive.hip() + std::min(1.0, 1e-4 / glm::length(way)) * way;
    const TickResult& out = drive.to(p);
    const double depth = glm::length(p - tip);
    wrong_proxy += glm::length(out.proxy - tip) <= 1e-6 * depth + 1e-10 ? 0 : 1;
    const double off = glm::length(out.force - kDefaultK * (tip - p));
    worst = std::max(worst, off);
    wrong_force += off <= 1e-6 * kDefaultK * depth + 1e-7 ? 0 : 1;
    without_contact += out.contact ? 0 : 1;
  }
  EXPECT_EQ(wrong_proxy, 0) << "of " << kGoTicks;
  EXPECT_EQ(wrong_force, 0) << "of " << kGoTicks << ", by up to " << worst << " N";
  EXPECT_EQ(without_contact, 0);
}

TEST(Apex, OfAHollowConeGivesTheForceOfItsTip) {
  for (const double degrees : {10.0, 18.4, 30.0, 45.0, 60.0, 80.0}) {
    SCOPED_TRACE(::testing::Message() << "half angle " << degrees);
    const double half = degrees * kDegree;
    const double height = 0.03;
    const FieldPtr field = cone(Vec3(0.0), Vec3(0, 0, 1), height * std::tan(half), height);
    feelTip(sceneOfSolid(field, true), Vec3(0, 0, 0.6 * height), height, half, 11);
  }
}

TEST(Apex, OfACountersinkGivesTheForceOfItsTip) {
  // A cone cut upside down into the top of a block, felt from above.
  for (const double degrees : {20.0, 45.0, 65.0}) {
    SCOPED_TRACE(::testing::Message() << "half angle " << degrees);
    const double half = degrees * kDegree;
    const double radius = 0.01 * std::tan(half);
    const FieldPtr sink = cone(mm(0, 0, -20), Vec3(0, 0, 1), radius, 0.01);
    const FieldPtr block = box(mm(0, 0, 5), {4.0 * radius, 4.0 * radius, 0.05});
    // The tip points along +z, at -10 mm: the hand is below it.
    feelTip(sceneOfSolid(subtract({block, sink})), mm(0, 0, -24), -0.01, half, 12);
  }
}

TEST(Apex, InThePlaneOfAnotherLayerAFrozenHandIsToldThatItRests) {
  // There, steps go around the tip for ever, within a nanometer.
  int unsettled = 0;
  double most = 0.0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const Vec3 tip = random.in({Vec3(-0.02), Vec3(0.02)});
    const Vec3 axis = random.direction();
    const double height = 0.02;
    SceneDescription description;
    description.layers.resize(2);
    description.layers[0].name = "half";
    description.layers[0].inside = std::make_shared<FieldSource>(
        intersect({halfSpace(tip, random.direction()), box(tip, Vec3(0.1))}));
    description.layers[1].name = "cone";
    description.layers[1].inside = std::make_shared<FieldSource>(
        cone(tip - height * axis, axis, height * std::tan(random.uniform(0.2, 1.2)), height));
    description.start_region = "cone";
    Drive drive(compile(description));
    (void)drive.to(tip - 0.5 * height * axis);
    for (int hand = 0; hand < 6; ++hand) {
      const Vec3 goal =
          tip + random.uniform(1e-4, 2e-3) * axis + random.uniform(0.0, 1e-3) * random.direction();
      (void)drive.walk(goal, 1e-4);
      for (int i = 0; i < 30; ++i) (void)drive.to(goal);
      const Vec3 force = drive.last().force;
      for (int i = 0; i < 10; ++i) {
        const TickResult out = drive.to(goal);
        unsettled += out.settled ? 0 : 1;
        most = std::max(most, glm::length(out.force - force));
      }
    }
  }
  EXPECT_EQ(unsettled, 0);
  EXPECT_LE(most, 1e-5);  // [N] a hundredth of what is required
}

TEST(Apex, CirclingInAConeGivesNoEnergy) {
  const ScenePtr scene = sceneOfSolid(cone(Vec3(0.0), Vec3(0, 0, 1), 0.010, 0.030), true);
  // The hand goes around the axis, from within the cone of normals to well outside it.
  for (const double radius : {0.3e-3, 1e-3, 2e-3, 3e-3}) {
    for (const double height : {28e-3, 30.5e-3, 32e-3}) {
      if (kSanitized && radius != 1e-3) continue;
      SCOPED_TRACE(::testing::Message() << "radius " << radius << ", height " << height);
      const auto lap = [&](int steps) {
        double work = 0.0;
        Drive drive(scene);
        (void)drive.to(Vec3(0, 0, 0.02));
        const auto at = [&](int i) {
          const double turn = 2.0 * std::numbers::pi * i / steps;
          // Not a level circle, on which no energy could be lost or gained.
          return Vec3(radius * std::cos(turn), radius * std::sin(turn),
                      height + 0.5 * radius * std::sin(2.0 * turn));
        };
        (void)drive.walk(at(0));
        for (int i = 0; i < 200; ++i) (void)drive.to(at(i - 200));
        Vec3 last = at(0);
        Vec3 force = drive.to(last).force;
        for (int i = 1; i <= steps; ++i) {
          const Vec3 p = at(i);
          const TickResult& out = drive.to(p);
          work += 0.5 * glm::dot(force + out.force, p - last);
          force = out.force;
          last = p;
        }
        return work;
      };
      // The error of the trapezoidal rule falls to a quarter when the step is halved.
      const double coarse = lap(8000);
      const double fine = lap(16'000);
      EXPECT_LE(std::min(fine, (4.0 * fine - coarse) / 3.0), 1e-9);
    }
  }
}

}  // namespace
}  // namespace palpate::test
