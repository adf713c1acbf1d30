// What a wall's material adds to its spring: a friction cone, damping, textures, shading.

#include <gtest/gtest.h>

#include <numbers>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

Material wallOf(double stiffness) {
  Material wall;
  wall.stiffness = stiffness;
  return wall;
}

Drive onFloor(const Material& wall) {
  Drive drive(sceneOfSolid(halfSpace(Vec3(0.0), Vec3(0, 0, 1)), false, wall));
  (void)drive.to(mm(0, 0, 1));
  return drive;
}

TEST(HardFriction, HysteresisLoopByClosedForm) {
  // Pressed 2 mm deep and pulled back and forth by 10 mm. While it sticks, the proxy lags by at
  // most 0.4 x 2 mm; while it slides, by 0.3 x 2 mm; after it turns around it sticks until the lag
  // is 0.8 mm in the other direction.
  Material wall = wallOf(1000.0);
  wall.friction = {0.4, 0.3};
  Drive drive = onFloor(wall);
  (void)drive.walk(mm(0, 0, -2));
  double proxy = 0.0;  // [mm]
  bool sticks = true;
  double work = 0.0;
  double last = 0.0;
  double last_force = 0.0;
  for (int i = 0; i <= 4000; ++i) {
    const double x = 10.0 * std::sin(0.01 * i);
    // The friction cone's rule, one line for each state.
    const double lag = x - proxy;
    if (sticks && std::fabs(lag) > 0.8) sticks = false;
    if (!sticks && std::fabs(lag) <= 0.6) sticks = true;
    if (!sticks) proxy = x - std::copysign(0.6, lag);
    const Vec3 force = drive.to(mm(x, 0, -2)).force;
    ASSERT_NEAR(force.z, 2.0, 1e-9);
    ASSERT_NEAR(force.y, 0.0, 1e-9);
    ASSERT_NEAR(force.x, proxy - x, 1e-5) << i << " at " << x;
    work += last_force * (x - last);
    last = x;
    last_force = force.x;
  }
  EXPECT_LT(work, -0.6 * 4 * 10) << "friction only takes [mJ]";
}

TEST(HardFriction, AStuckProxyDoesNotCreep) {
  Material wall = wallOf(1000.0);
  wall.friction = {0.5, 0.4};
  for (const bool curved : {false, true}) {
    const FieldPtr field =
        curved ? sphere(mm(0, 0, -30), 0.03) : halfSpace(Vec3(0.0), Vec3(0, 0, 1));
    Drive drive(sceneOfSolid(field, false, wall));
    (void)drive.to(mm(0, 0, 1));
    (void)drive.walk(mm(0, 0, -2));
    const Vec3 held = drive.last().proxy;
    Random random(3);
    for (int i = 0; i < 20'000; ++i) {
      // Trembling within the static cone.
      const Vec3 p = mm(0.4, 0.2, -2.0) + 0.2e-3 * random.direction();
      ASSERT_TRUE(isNear(drive.to(p).proxy, held, 1e-9)) << i << (curved ? " on a ball" : "");
    }
  }
}

TEST(HardFriction, SlidesAtTheKineticConeOnABall) {
  // Along a meridian at constant depth: the force is tilted backward from the normal at the proxy
  // by atan(mu_k).
  Material wall = wallOf(1000.0);
  wall.friction = {0.3, 0.2};
  const double radius = 0.05;
  Drive drive(sceneOfSolid(sphere(Vec3(0.0), radius), false, wall));
  (void)drive.to(Vec3(radius + 0.001, 0, 0));
  (void)drive.walk(Vec3(radius - 0.001, 0, 0));
  for (double angle = 0.0; angle < 6.0; angle += 0.004) {
    const Vec3 hip = (radius - 0.001) * Vec3(std::cos(angle), std::sin(angle), 0);
    const TickResult& out = drive.to(hip);
    const Vec3 n = out.proxy / radius;
    const double normal = glm::dot(out.force, n);
    const double along = glm::length(out.force - normal * n);
    ASSERT_LE(along, 0.3 * normal + 1e-9) << angle;
    if (angle > 0.1) {
      ASSERT_NEAR(along / normal, 0.2, 2e-6) << angle;
      ASSERT_NEAR(glm::length(out.proxy), radius, 1e-9);
      ASSERT_LT(out.force.x * -std::sin(angle) + out.force.y * std::cos(angle), 0.0) << "backwards";
    }
  }
}

TEST(HardDamping, IsOfTheVelocityAndNeverPulls) {
  Material wall = wallOf(1000.0);
  wall.damping = 5.0;
  Drive drive = onFloor(wall);
  Random random(2);
  Vec3 p = mm(0, 0, -1);
  for (int i = 0; i < 5000; ++i) {
    p = random.in({mm(-10, -10, -3), mm(10, 10, -0.01)});
    const Vec3 velocity = random.in({Vec3(-1.0), Vec3(1.0)});
    const TickResult out = drive.renderer().update({p, velocity});
    const double normal = std::max(0.0, -1000.0 * p.z - 5.0 * velocity.z);
    const Vec3 expected(-5.0 * velocity.x, -5.0 * velocity.y, normal);
    ASSERT_TRUE(isNear(out.force, expected, 1e-9)) << i;
  }
  EXPECT_EQ(drive.renderer().update({mm(0, 0, 1), Vec3(1.0)}).force, Vec3(0.0)) << "free";
}

TEST(HardTexture, IsCappedByAmplitudeAndDepth) {
  Material wall = wallOf(1000.0);
  wall.texture = {0.2e-3, 3e-3};
  Drive drive = onFloor(wall);
  double highest = 0.0;
  double lowest = 0.0;
  for (const double depth : {0.01e-3, 0.1e-3, 0.3e-3, 2e-3}) {
    (void)drive.to(mm(0, 0, 1));
    for (int i = 0; i < 3000; ++i) {
      const Vec3 p = mm(0.01 * i, 0.017 * i, -1e3 * depth);
      const TickResult& out = drive.to(p);
      ASSERT_TRUE(out.contact) << "never lost by its own texture";
      const double added = out.force.z - 1000.0 * depth;
      ASSERT_LE(std::fabs(added), 1000.0 * 0.2e-3 + 1e-9) << depth;
      ASSERT_LE(std::fabs(added), 0.5 * 1000.0 * depth + 1e-9) << depth;
      // The force along the wall follows the slope of the bumps: amplitude k / 3 along at most two
      // axes.
      const double slope = 0.2e-3 * 2.0 * std::numbers::pi / 3e-3 / 3.0 * std::sqrt(2.0);
      ASSERT_LE(glm::length(Vec3(out.force.x, out.force.y, 0)), 1000.0 * depth * slope + 1e-9);
      highest = std::max(highest, added);
      lowest = std::min(lowest, added);
    }
  }
  // At z = 0 the wave along z is zero, so two of the three contribute.
  EXPECT_GT(highest, 0.9 * 1000.0 * 0.2e-3 * 2.0 / 3.0);
  EXPECT_LT(lowest, -0.9 * 1000.0 * 0.2e-3 * 2.0 / 3.0);
}

/// A rod with 24 flat sides about z, 30 mm thick; `one_leaf`: without its faces as structure, as a
/// mesh is felt.
FieldPtr facetedRod() {
  std::vector<FieldPtr> sides;
  for (int i = 0; i < 24; ++i) {
    const double a = 15.0 * i * kDegree;
    const Vec3 u(std::cos(a), std::sin(a), 0);
    sides.push_back(halfSpace(0.03 * u, u));
  }
  return intersect(std::move(sides));
}

/// Largest turn of the force between two ticks during a stroke around the rod [degree].
double largestTurn(double shading) {
  Material wall = wallOf(1000.0);
  wall.shading = shading;
  Drive drive(sceneOfSolid(facetedRod(), false, wall));
  (void)drive.to(mm(40, 0, 0));
  (void)drive.walk(mm(29, 0, 0));
  double turn = 0.0;
  Vec3 last(1, 0, 0);
  for (double angle = 0.0; angle < 6.28; angle += 0.002) {
    const Vec3 force = drive.to(0.029 * Vec3(std::cos(angle), std::sin(angle), 0)).force;
    turn = std::max(turn, std::atan2(glm::length(glm::cross(force, last)), glm::dot(force, last)));
    last = force;
  }
  return turn / kDegree;
}

TEST(HardShading, FacetsFeelRound) {
  EXPECT_NEAR(largestTurn(0.0), 15.0, 0.1) << "without it every edge is felt";
  // With shading, the remaining turn is that of the smoothed surface while the proxy goes over an
  // edge, from 0.13 mm before it to 0.13 mm behind it: 0.4 degree of the 15 over 10 mm, up to twice
  // that because of its curvature, half a degree more because the bevel lies lower than the faces,
  // and the hand's own 0.11 degree.
  EXPECT_LE(largestTurn(5e-3), 2.0);
}

TEST(HardShading, LeavesSmoothWallsAlone) {
  Material wall = wallOf(1000.0);
  wall.shading = 1e-3;
  Drive drive(sceneOfSolid(sphere(Vec3(0.0), 0.05), false, wall));
  (void)drive.to(mm(60, 0, 0));
  (void)drive.walk(mm(49, 0, 0));
  Random random(8);
  for (int i = 0; i < 200; ++i) {
    const double t = 0.02 * i;
    const Vec3 p = 0.049 * Vec3(std::cos(t) * std::cos(0.7 * t), std::sin(t) * std::cos(0.7 * t),
                                std::sin(0.7 * t));
    const Vec3 force = drive.to(p).force;
    // The smoothed ball is smaller by a ninth of radius^2 / (2 R) for each of its two curvatures;
    // depending on the position of the smoothing's lattice, its surface waves by a hundredth of
    // that.
    const double lower = 1e-3 * 1e-3 / 9.0 / 0.05;
    ASSERT_TRUE(
        isNear(force, kDefaultK * (0.001 - lower) * glm::normalize(p), 0.1 * kDefaultK * lower))
        << i;
  }
}

}  // namespace
}  // namespace palpate::test
