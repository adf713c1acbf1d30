// Walls that share one press: force, tangent and gradients are those of the energy that they store
// together.

#include "palpate/contact/shared_walls.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/field_contract.h"

namespace palpate::test {
namespace {

SharedWall feltOf(const WallLaw& law) {
  SharedWall out;
  out.law = law;
  return out;
}

const WallLaw kStraight{{700.0, 0.0, 1.0, 1.0}};
const WallLaw kHertz{{900.0, 0.0, 1.5, 1e-3}};
const WallLaw kBumpy{{1500.0, 2e4, 1.0, 1.0}, 0.1e-3};

TEST(SharedWalls, OfOneAreThatOne) {
  SharedWalls walls;
  walls.add(feltOf(kHertz));
  EXPECT_TRUE(walls.isEven());
  for (const double depth : {0.0, 0.3e-3, 2e-3}) {
    EXPECT_EQ(walls.force(depth), kHertz.force(depth));
    EXPECT_EQ(walls.energy(depth), kHertz.energy(depth));
    EXPECT_EQ(walls.rise(depth), Vec3(0.0));
    EXPECT_EQ(walls.byPress(depth), Vec3(0.0));
  }
}

TEST(SharedWalls, PushByTheSlopeOfWhatTheyStore) {
  SharedWalls walls;
  walls.add(feltOf(kStraight), 0.5);
  walls.add(feltOf(kHertz), 0.3);
  walls.add(feltOf(kBumpy), 0.2);
  EXPECT_FALSE(walls.isStraight());
  for (const double depth : {0.05e-3, 0.4e-3, 1.3e-3}) {
    constexpr double kStep = 1e-8;
    const double slope = (walls.energy(depth + kStep) - walls.energy(depth - kStep)) / (2 * kStep);
    const double rate = (walls.force(depth + kStep) - walls.force(depth - kStep)) / (2 * kStep);
    // Differences over a step of 0.02 um.
    EXPECT_NEAR(walls.force(depth), slope, 1e-6 * slope);
    EXPECT_NEAR(walls.tangent(depth), rate, 1e-5 * rate);
    // In series with a stop, walls and stop exert the same force.
    const SoftWall soft = softWall(walls, 5000.0, depth);
    EXPECT_NEAR(soft.force, walls.force(soft.depth), 1e-12);
    EXPECT_NEAR(soft.depth - soft.force / 5000.0, depth, 1e-15);
  }
}

TEST(SharedWalls, RiseByWhatTheirSharesAndLawsChangeBy) {
  Random random(3);
  const Vec3 to_second = 80.0 * random.direction();
  const Vec3 by_press = 60.0 * random.direction();
  const Vec3 steeper = 3e4 * random.direction();
  const auto at = [&](const Vec3& place, const Vec3& press) {
    SharedWalls walls;
    SharedWall second = feltOf(kHertz);
    second.law.spring.stiffness += glm::dot(steeper, place);
    second.stiffness_rise = steeper;
    const double share = 0.4 + glm::dot(to_second, place) + glm::dot(by_press, press);
    walls.add(feltOf(kStraight), 1.0 - share, -to_second, -by_press);
    walls.add(second, share, to_second, by_press);
    return walls;
  };
  constexpr double kStep = 1e-7;
  for (const double depth : {0.2e-3, 1.1e-3}) {
    const SharedWalls here = at(Vec3(0.0), Vec3(0.0));
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 by(0.0);
      by[axis] = kStep;
      const auto slope = [&](const SharedWalls& more, const SharedWalls& less) {
        return (more.energy(depth) - less.energy(depth)) / (2.0 * kStep);
      };
      // Differences of some 1e-4 J, known to 1e-16 of that, over 0.2 um.
      EXPECT_NEAR(here.rise(depth)[axis], slope(at(by, Vec3(0.0)), at(-by, Vec3(0.0))), 1e-9);
      EXPECT_NEAR(here.byPress(depth)[axis], slope(at(Vec3(0.0), by), at(Vec3(0.0), -by)), 1e-9);
    }
  }
}

TEST(SharedWalls, OfMoreThanThereIsRoomForTheLeastIsLeftOut) {
  SharedWalls walls;
  for (const double share : {0.3, 0.05, 0.25, 0.2, 0.2}) walls.add(feltOf(kStraight), share);
  EXPECT_EQ(walls.count(), SharedWalls::kMost);
  EXPECT_NEAR(walls.force(1e-3), 0.95 * 0.7, 1e-12);
}

}  // namespace
}  // namespace palpate::test
