// Newton's slide against closed forms: on a ball, a cylinder and a circular crease one step of it points
// straight at the goal, R tan(angle) away.

#include "palpate/contact/slide.h"

#include <gtest/gtest.h>

#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

constexpr double kR = 0.04;

HeldWall heldAt(const FieldPtr& field, double side, const Vec3& x) {
  HeldWall wall;
  wall.field = field.get();
  wall.side = side;
  wall.tolerance = 1e-9 * field->featureSize();
  wall.jet = field->jet(x);
  wall.normal = side * glm::normalize(wall.jet.gradient);
  return wall;
}

/// The point at `angle` around z and distance rho from it.
Vec3 around(double angle, double rho) {
  return {rho * std::cos(angle), rho * std::sin(angle), 0.0};
}

TEST(SlideStep, BallConvexAndHollow) {
  const FieldPtr ball = sphere(Vec3(0.0), kR);
  const Vec3 x(kR, 0, 0);
  for (const double side : {1.0, -1.0}) {
    for (const double depth : {1e-5, 1e-3, 0.5 * kR, 0.9 * kR}) {
      for (const double angle : {1e-9, 1e-3, 0.1, 0.4, -0.3}) {
        const Vec3 wish = around(angle, kR - side * depth) - x;
        HeldWall wall = heldAt(ball, side, x);
        wall.multiplier = -glm::dot(wall.normal, wish);
        if (wall.multiplier <= 0.0) continue;
        const std::span<const HeldWall> walls(&wall, 1);
        const Vec3 pull = tangentialPart(wish, walls);
        const SlideStep out = slideStep(pull, walls);
        // Eigenvalues below 0.02 are raised, and that is the only way off the closed form.
        if ((kR - side * depth) * std::cos(angle) / kR < 0.02) continue;
        EXPECT_LT(glm::length(out.step - Vec3(0, kR * std::tan(angle), 0)),
                  1e-12 * kR + 1e-9 * std::fabs(angle) * kR)
            << side << " " << depth << " " << angle;
        EXPECT_FALSE(out.is_saddle);
      }
    }
  }
}

TEST(SlideStep, TurnsAtMostHalfARadian) {
  const FieldPtr ball = sphere(Vec3(0.0), kR);
  const Vec3 x(kR, 0, 0);
  HeldWall wall = heldAt(ball, 1.0, x);
  const Vec3 wish = around(1.2, 0.9 * kR) - x;
  wall.multiplier = -glm::dot(wall.normal, wish);
  const std::span<const HeldWall> walls(&wall, 1);
  EXPECT_NEAR(glm::length(slideStep(tangentialPart(wish, walls), walls).step), 0.5 * kR, 1e-12);
}

TEST(SlideStep, CylinderBendsAroundAndRunsStraightAlong) {
  const FieldPtr tube = cylinder(Vec3(0.0), Vec3(0, 0, 1), kR, 10.0);
  const Vec3 x(kR, 0, 0);
  for (const double side : {1.0, -1.0}) {
    const Vec3 goal = around(0.2, kR - side * 0.004) + Vec3(0, 0, 0.013);
    HeldWall wall = heldAt(tube, side, x);
    wall.multiplier = -glm::dot(wall.normal, goal - x);
    const std::span<const HeldWall> walls(&wall, 1);
    const Vec3 step = slideStep(tangentialPart(goal - x, walls), walls).step;
    EXPECT_NEAR(step.y, kR * std::tan(0.2), 1e-10);
    EXPECT_NEAR(step.z, 0.013, 1e-12);
    EXPECT_NEAR(step.x, 0.0, 1e-15);
  }
}

TEST(SlideStep, CreaseOfABallAndAPlane) {
  const FieldPtr ball = sphere(Vec3(0.0), kR);
  const FieldPtr floor = halfSpace(Vec3(0.0), Vec3(0, 0, 1));
  const Vec3 x(kR, 0, 0);
  std::array<HeldWall, 2> walls{heldAt(ball, 1.0, x), heldAt(floor, 1.0, x)};
  const Vec3 wish = around(0.3, 0.8 * kR) - Vec3(0, 0, 0.01) - x;
  walls[0].multiplier = -wish.x;
  walls[1].multiplier = 0.01;
  const Vec3 pull = tangentialPart(wish, walls);
  EXPECT_LT(glm::length(pull - Vec3(0, wish.y, 0)), 1e-15);
  EXPECT_LT(glm::length(slideStep(pull, walls).step - Vec3(0, kR * std::tan(0.3), 0)), 1e-12);
  // Three walls leave nothing to slide along; nor do two that are the same.
  const FieldPtr side = halfSpace(Vec3(0.0), Vec3(0, 1, 0));
  const std::array<HeldWall, 3> corner{walls[0], walls[1], heldAt(side, 1.0, x)};
  EXPECT_EQ(tangentialPart(wish, corner), Vec3(0.0));
  EXPECT_EQ(slideStep(wish, corner).step, Vec3(0.0));
  const std::array<HeldWall, 2> same{walls[1], walls[1]};
  EXPECT_EQ(tangentialPart(wish, same), Vec3(0.0));
}

TEST(SlideStep, BeyondTheCenterOfABallIsASaddle) {
  const FieldPtr ball = sphere(Vec3(0.0), kR);
  const Vec3 x(kR, 0, 0);
  for (const double depth : {0.5, 0.99, 1.01, 1.5}) {
    HeldWall wall = heldAt(ball, 1.0, x);
    wall.multiplier = depth * kR;
    const std::span<const HeldWall> walls(&wall, 1);
    const SlideStep out = slideStep(Vec3(0.0), walls);
    EXPECT_EQ(out.is_saddle, depth > 1.0) << depth;
    if (depth > 1.0) {
      EXPECT_TRUE(mayBeSaddle(walls));
      EXPECT_NEAR(glm::length(out.downhill), 1.0, 1e-12);
      EXPECT_NEAR(glm::dot(out.downhill, wall.normal), 0.0, 1e-12);
    }
    if (depth < 0.5) {
      EXPECT_FALSE(mayBeSaddle(walls));
    }
  }
}

TEST(PullBack, LandsOnOneTwoAndThreeWalls) {
  const FieldPtr ball = sphere(Vec3(0.0), kR);
  const FieldPtr second = sphere(Vec3(0.03, 0, 0), kR);
  const FieldPtr floor = halfSpace(Vec3(0.0), Vec3(0, 0, 1));
  Random random(8);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 crease(0.015, std::sqrt(kR * kR - 0.015 * 0.015),
                      0.0);  // of both balls, on the floor
    const Vec3 from = crease + random.in({Vec3(-0.005), Vec3(0.005)});
    for (const std::size_t count : {1U, 2U, 3U}) {
      std::vector<HeldWall> walls{heldAt(ball, 1.0, crease), heldAt(second, 1.0, crease),
                                  heldAt(floor, 1.0, crease)};
      walls.resize(count);
      Vec3 x = from;
      bool began_free = false;
      ASSERT_TRUE(pullBack(x, walls, began_free));
      bool free = true;
      for (const HeldWall& wall : walls) {
        EXPECT_LE(std::fabs(wall.field->value(x)), wall.tolerance);
        free = free && wall.field->value(from) >= -wall.tolerance;
      }
      EXPECT_EQ(began_free, free);
      if (count == 1) {
        EXPECT_LT(glm::length(x - glm::normalize(from) * kR), 1e-10) << "radially";
      }
      if (count == 3) {
        EXPECT_LT(glm::length(x - crease), 1e-9) << "only one point is left";
      }
    }
  }
}

TEST(PullBack, RefusesWhatHasNoGradientOrNoCommonPoint) {
  struct Flat final : Field {
    [[nodiscard]] FieldSample sample(const Vec3&) const noexcept override {
      return {0.5, Vec3(0.0)};
    }
    [[nodiscard]] Box3 bounds() const noexcept override { return Box3::everything(); }
    [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
    [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
    [[nodiscard]] double featureSize() const noexcept override { return 1.0; }
  };
  HeldWall flat;
  const Flat field;
  flat.field = &field;
  flat.tolerance = 1e-9;
  Vec3 x(0.1);
  bool began_free = false;
  EXPECT_FALSE(pullBack(x, {&flat, 1}, began_free));
  const Vec3 p(0.0);
  const FieldPtr low = halfSpace(p, Vec3(0, 0, 1));
  const FieldPtr high = halfSpace(Vec3(0, 0, 1), Vec3(0, 0, 1));
  const std::array<HeldWall, 2> walls{heldAt(low, 1.0, p), heldAt(high, 1.0, p)};
  EXPECT_FALSE(pullBack(x, walls, began_free));
}

}  // namespace
}  // namespace palpate::test
