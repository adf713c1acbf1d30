// Places where a surface has no normal, or the field no scale: apexes, cusps, saddles, gradients
// that vary a hundredfold.

#include <gtest/gtest.h>

#include <cstdlib>

#include "lib/render/hard_judge.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

int walkTicks() { return std::getenv("PALPATE_SLOW_TESTS") != nullptr ? 20'000 : 600; }

TEST(HardSingular, MetaballSaddle) {
  // Two balls that blend into each other: the neck between them has curvatures of both signs.
  const FieldPtr field =
      metaballs({{mm(-15, 0, 0), 0.04, 1.0}, {mm(15, 0, 0), 0.04, 1.0}}, FallOff::kWyvill, 0.6);
  {
    Judge judge(field, false);
    judgeWalk(judge, mm(0, 40, 0), {mm(-25, -12, -12), mm(25, 12, 12)}, 0.3, 1, walkTicks());
  }
  {
    Judge judge(field, true);
    judgeWalk(judge, mm(15, 0, 0), {mm(-40, -25, -25), mm(40, 25, 25)}, 0.3, 2, walkTicks());
  }
}

/// A ball whose value is the distance times a factor that varies from 1 to 100 over its surface.
FieldPtr unevenBall(double radius) {
  UserFunction f;
  f.value = [=](const Vec3& p) {
    const double factor = std::pow(100.0, 0.5 * (1.0 + std::tanh(3.0 * p.x / radius)));
    return 0.01 * factor * (glm::length(p) - radius);
  };
  f.bounds = {Vec3(-1.01 * radius), Vec3(1.01 * radius)};
  f.feature_size = radius;
  f.lipschitz = 8.0;  // factor 1, plus its own growth of 3 ln 10 / R over the space within 2 R
  f.lipschitz_domain = {Vec3(-2.0 * radius), Vec3(2.0 * radius)};
  return userField(std::move(f));
}

TEST(HardSingular, GradientMagnitudeVariesAHundredTimes) {
  const FieldPtr field = unevenBall(0.02);
  {
    Judge judge(field, false);
    judgeWalk(judge, mm(0, 30, 0), {mm(-19, -14, -14), mm(19, 14, 14)}, 0.2, 3, walkTicks());
  }
  {
    Judge judge(field, true);
    judgeWalk(judge, mm(0, 0, 0), {mm(-22, -22, -22), mm(22, 22, 22)}, 0.2, 4, walkTicks());
  }
}

TEST(HardSingular, ConeApexFromOutside) {
  // Pressed on the tip of a cone, 40 mm high on a disc of 15 mm: held by the slant on the side
  // where it slid down.
  const FieldPtr field = cone(Vec3(0.0), Vec3(0, 0, 1), 0.015, 0.04);
  Judge judge(field, false);
  judge.stepOracleBy(100e-6);
  judge.onlyWhere([](const Vec3& p) {
    return p.z > 0.04 || std::hypot(p.x, p.y) > 0.1 * (0.04 - p.z) * 0.015 / 0.04;
  });
  judgeWalk(judge, mm(0, 0, 60), {mm(-6, -6, 10), mm(6, 6, 45)}, 0.2, 5, walkTicks());
}

TEST(HardSingular, ConeApexStraightOn) {
  // Exactly on the axis any side is right; the force is finite, does not pull, and the proxy stays
  // outside.
  const FieldPtr field = cone(Vec3(0.0), Vec3(0, 0, 1), 0.015, 0.04);
  Drive drive(sceneOfSolid(field));
  (void)drive.walk(mm(0, 0, 60));
  for (double z = 60.0; z > 20.0; z -= 0.1) {
    const TickResult& out = drive.to(mm(0, 0, z));
    ASSERT_TRUE(isFinite(out.force));
    ASSERT_GE(field->value(out.proxy), -1e-9);
    ASSERT_GE(glm::dot(out.force, out.proxy - drive.hip()), 0.0);
    // The distance to the slant is 0.351 of the depth along the axis: (40 - z) sin(half angle).
    if (z < 39.9) {
      ASSERT_LE(glm::length(out.force), kDefaultK * 1e-3 * (40.0 - z) + 1e-9) << z;
      ASSERT_GE(glm::length(out.force), kDefaultK * 1e-3 * (40.0 - z) * 0.351) << z;
    }
  }
  EXPECT_EQ(drive.walk(mm(0, 0, 60)).force, Vec3(0.0));
}

TEST(HardSingular, StraightThroughABallsCenterTheNearSideIsFelt) {
  // Beyond the center the distance is stationary at the entry point too, but there it is the
  // largest of all: a proxy held there would give 35 N.
  for (const Vec3& way : {Vec3(0, 0, 1), Vec3(1, 0, 0), glm::normalize(Vec3(1, 2, 3))}) {
    Drive drive(sceneOfSolid(sphere(Vec3(0.0), 0.02)));
    (void)drive.to(0.03 * way);
    const TickResult out = drive.walk(-0.015 * way);
    EXPECT_TRUE(out.settled);
    EXPECT_TRUE(isNear(out.proxy, -0.02 * way, 1e-8));
    EXPECT_TRUE(isNear(out.force, -5.0 * way, 1e-5));
  }
}

TEST(HardSingular, HollowConeApex) {
  // The hand is beyond the tip, pressed from inside: the tip is nearest as long as P is in the cone
  // of normals.
  const FieldPtr field = cone(Vec3(0.0), Vec3(0, 0, 1), 0.015, 0.04);
  Drive drive(sceneOfSolid(field, true));
  (void)drive.walk(mm(0, 0, 10));
  Random random(6);
  double worst = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.01 * i;
    const Vec3 p = mm(0.8 * std::sin(3 * t), 0.8 * std::cos(2 * t), 42.0 + std::sin(t));
    const TickResult& out = drive.to(p);
    ASSERT_LE(field->value(out.proxy), 1e-9);
    if (i < 5) continue;
    worst = std::max(worst, glm::length(out.proxy - mm(0, 0, 40)) / glm::length(p - mm(0, 0, 40)));
  }
  EXPECT_LE(worst, 1e-6);
}

TEST(HardSingular, HeartFromOutside) {
  const FieldPtr field = heart(Vec3(0.0), 0.06);
  Judge judge(field, false);
  judge.stepOracleBy(
      200e-6);  // its feature size, the tip's radius, is a hundredth of what matters here
  judgeWalk(judge, mm(0, 30, 10), {mm(-26, -10, -22), mm(26, 10, 25)}, 0.4, 7, walkTicks() / 3);
}

TEST(HardSingular, HeartCuspPressed) {
  // The hand presses into the dimple between the lobes, and onto the tip below: the force is finite
  // and steady, and the proxy never inside.
  const FieldPtr field = heart(Vec3(0.0), 0.06);
  for (const double up : {1.0, -1.0}) {
    Drive drive(sceneOfSolid(field));
    (void)drive.to(mm(0, 0, up * 60));
    Vec3 last(0.0);
    for (double z = 60.0; z > 10.0; z -= 0.1) {
      const TickResult& out = drive.to(mm(0.1 * std::sin(z), 0, up * z));
      ASSERT_TRUE(isFinite(out.force));
      ASSERT_GE(field->value(out.proxy), -1e-9) << z;
      ASSERT_LE(glm::length(out.force), kDefaultK * glm::length(out.proxy - drive.hip()) + 1e-9);
    }
    EXPECT_TRUE(drive.last().contact);
    // At rest the force stays the same.
    last = drive.last().force;
    for (int i = 0; i < 20; ++i) {
      const Vec3 force = drive.to(drive.hip()).force;
      ASSERT_TRUE(i < 3 || isNear(force, last, 1e-6)) << i;
      last = force;
    }
  }
}

}  // namespace
}  // namespace palpate::test
