// The point of some walls nearest to a hand converges wherever the steps begin: also if steps are
// shortened because of the walls' curvature, or alternate between faces of one wall.

#include "palpate/contact/local_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lib/contact/outside_of.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// A hand up to 6 mm below the origin, where the walls' surfaces meet.
Vec3 handBelow(Random& random) {
  const Vec3 u = random.direction();
  return 6e-3 * (u.z > 0.0 ? -u : u);
}

/// The walls' forces add up to the whole way from the point to the hand.
void expectHeld(const LocalProjection& out, const Vec3& hand, int trial) {
  ASSERT_TRUE(out.settled) << trial;
  Vec3 rest = hand - out.at;
  for (std::size_t k = 0; k < out.count; ++k) {
    EXPECT_GE(out.held[k].multiplier, 0.0);
    rest += out.held[k].multiplier * out.held[k].normal;
  }
  // Settled means that a step is below 1e-12 of the way; where two walls almost coincide, the
  // remainder is larger.
  EXPECT_LT(glm::length(rest), 1e-9 * glm::length(hand - out.at) + 1e-15) << trial;
}

TEST(LocalProjection, SettlesOnAnEllipsoidSmallerThanTheWay) {
  Random random(31);
  for (int i = 0; i < 1000; ++i) {
    const double low = random.uniform(2e-3, 22e-3);
    const Vec3 radii(random.uniform(2e-3, 22e-3), random.uniform(2e-3, 22e-3), low);
    const FieldPtr field = ellipsoid(Vec3(0, 0, -low), radii);
    const std::vector<HeldWall> walls{outsideOf(field)};
    const Vec3 hand = handBelow(random);
    expectHeld(projectLocally(Vec3(0.0), hand, walls), hand, i);
  }
}

/// A ball's distance is only as exact as its center's coordinates: steps never get shorter than
/// that.
TEST(LocalProjection, SettlesOnABallWhoseCenterIsFarFromAShortWay) {
  Random random(34);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 u = random.direction();
    const double radius = random.uniform(10e-3, 100e-3);
    const FieldPtr ball = sphere((u.z > 0.0 ? -radius : radius) * u, radius);
    const std::vector<HeldWall> walls{outsideOf(ball)};
    const Vec3 hand = std::pow(10.0, random.uniform(-5.0, -2.0)) * handBelow(random);
    expectHeld(projectLocally(0.1 * hand, hand, walls), hand, i);
  }
}

TEST(LocalProjection, SettlesBetweenTwoBalls) {
  Random random(32);
  for (int i = 0; i < 1000; ++i) {
    std::vector<FieldPtr> balls;
    for (int k = 0; k < 2; ++k) {
      const Vec3 u = random.direction();
      const double radius = random.uniform(2e-3, 22e-3);
      balls.push_back(sphere((u.z > 0.0 ? -radius : radius) * u, radius));
    }
    const std::vector<HeldWall> walls{outsideOf(balls[0]), outsideOf(balls[1])};
    const Vec3 hand = handBelow(random);
    expectHeld(projectLocally(Vec3(0.0), hand, walls), hand, i);
  }
}

TEST(LocalProjection, SettlesOnTheFacesOfOneWallFromBothSides) {
  Random random(33);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 size(random.uniform(2e-3, 22e-3), random.uniform(2e-3, 22e-3),
                    random.uniform(2e-3, 22e-3));
    // One of the box's corners is at the origin, except for rounding.
    const FieldPtr field = roundedBox(-0.5 * size, size, 0.5e-3);
    std::vector<HeldWall> walls{outsideOf(field)};
    if (i % 2 == 1)
      walls[0].side = -1.0;  // the hand is held inside, where full steps would alternate
    const Vec3 hand = handBelow(random);
    expectHeld(projectLocally(Vec3(0.0), hand, walls), hand, i);
  }
}

TEST(LocalProjection, FindsTheCircleWhereTwoBallsMeet) {
  const FieldPtr left = sphere(Vec3(-0.006, 0, 0), 0.01);
  const FieldPtr right = sphere(Vec3(0.006, 0, 0), 0.01);
  const std::vector<HeldWall> walls{outsideOf(left), outsideOf(right)};
  const double radius = 0.008;
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const double angle = random.uniform(-0.5, 0.5);
    const Vec3 from(0.0, radius * std::sin(angle), radius * std::cos(angle));
    const double turned = angle + random.uniform(-0.2, 0.2);
    const Vec3 target(random.uniform(-1e-4, 1e-4), 0.006 * std::sin(turned),
                      0.006 * std::cos(turned));
    const LocalProjection out = projectLocally(from, target, walls);
    ASSERT_TRUE(out.settled) << i;
    ASSERT_EQ(out.count, 2U) << i;
    const Vec3 expected(0.0, radius * std::sin(turned), radius * std::cos(turned));
    // Newton's last step is below 1e-12 of the way of 2 mm.
    EXPECT_LT(glm::length(out.at - expected), 1e-14) << i;
  }
}

TEST(LocalProjection, LeavesWhatIsAllowedAlone) {
  const FieldPtr ball = sphere(Vec3(0.0), 0.01);
  const std::vector<HeldWall> walls{outsideOf(ball)};
  const LocalProjection out = projectLocally(Vec3(0, 0, 0.01), Vec3(0.001, 0, 0.012), walls);
  EXPECT_TRUE(out.settled);
  EXPECT_EQ(out.count, 0U);
  EXPECT_EQ(out.at, Vec3(0.001, 0, 0.012));
}

TEST(LocalProjection, SettlesFarFromTheOriginDownToRounding) {
  // At a thousand times the way to the target, the rounding of a step is longer than 1e-12 of that
  // way.
  const Vec3 center(3.0, -2.0, 1.0);
  const FieldPtr ball = sphere(center, 0.01);
  const std::vector<HeldWall> walls{outsideOf(ball)};
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 u = random.direction();
    const Vec3 v = glm::normalize(u + 0.3 * random.direction());
    const LocalProjection out = projectLocally(center + 0.01 * u, center + 0.009 * v, walls);
    ASSERT_TRUE(out.settled) << i;
    ASSERT_EQ(out.count, 1U) << i;
    EXPECT_LT(glm::length(out.at - (center + 0.01 * v)), 1e-13) << i;
  }
}

/// The proxy is inside a cone that stands on its tip: if the target is in the cone of the tip's
/// normals, the tip is the nearest place, else the foot on the side is.
TEST(LocalProjection, ByCutsFindsTheTipAndTheSideOfAHollowCone) {
  const double height = 4e-3;
  const FieldPtr field = cone(Vec3(0.0, 0.0, height), Vec3(0.0, 0.0, -1.0), height, height);
  std::vector<HeldWall> walls{outsideOf(field)};
  walls[0].side = -1.0;
  const Vec3 from(0.0, 0.0, 1e-3);
  Random random(36);
  int at_tip = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 target = random.in({Vec3(-1e-3, -1e-3, -2e-3), Vec3(1e-3, 1e-3, 0.8e-3)});
    const double out = std::hypot(target.x, target.y);
    const LocalProjection on = projectByCuts(from, target, walls);
    ASSERT_TRUE(on.settled) << i;
    if (out <= target.z) {
      EXPECT_EQ(on.count, 0U) << i;
      EXPECT_EQ(on.at, target) << i;
      continue;
    }
    // The side rises by as much as it goes outward.
    const double along = 0.5 * (out + target.z);
    const bool is_tip = along <= 0.0;
    const Vec3 expected =
        is_tip ? Vec3(0.0) : Vec3(along * target.x / out, along * target.y / out, along);
    EXPECT_LT(glm::length(on.at - expected), 1e-11) << i;
    ASSERT_GT(on.count, 0U) << i;
    at_tip += is_tip ? 1 : 0;
  }
  EXPECT_GT(at_tip, 100);
}

TEST(LocalProjection, ByCutsIsNotSettledOnABulge) {
  const FieldPtr ball = sphere(Vec3(0.0, 0.0, -2e-3), 2e-3);
  const std::vector<HeldWall> walls{outsideOf(ball)};
  EXPECT_FALSE(projectByCuts(Vec3(0.0), Vec3(1.5e-3, 0.0, -2e-3), walls).settled);
}

}  // namespace
}  // namespace palpate::test
