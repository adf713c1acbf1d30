// A hand in the plane of an adjacent face, or off it by rounding: the proxy follows the hand along
// the edge.

#include <gtest/gtest.h>

#include <algorithm>

#include "lib/render/hard_judge.h"
#include "lib/render/opaque.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

struct Behind {
  double most = 0.0;  ///< [m] distance of the proxy from its correct place
  int ticks = 0;      ///< number in which that was more than allowed
};

/// The proxy is inside a box of 60 x 40 x 20 mm; the hand, 3 mm beyond x = 30 mm and `aside` beyond
/// z = 10 mm, moves along y by 20 mm.
Behind alongEdge(double aside, const Material& wall, double allowed, double rest_from_y) {
  Drive drive(sceneOfSolid(box(Vec3(0.0), mm(60, 40, 20)), true, wall));
  (void)drive.to(Vec3(0.0));
  (void)drive.walk(mm(20, -10, 0));
  const double z = 0.010 + aside;
  (void)drive.walk({0.033, -0.010, z});
  Behind out;
  for (int i = 1; i <= 400; ++i) {
    const double y = -0.010 + 0.05e-3 * i;
    const TickResult& tick = drive.to({0.033, y, z});
    const Vec3 right(0.030, y, std::min(z, 0.010));
    const double off = glm::length(tick.proxy - right);
    out.most = std::max(out.most, off);
    if (off > allowed && y > rest_from_y) ++out.ticks;
  }
  return out;
}

class LeftBehind : public ::testing::TestWithParam<double> {};

TEST_P(LeftBehind, NotWithoutFriction) {
  const Behind behind = alongEdge(GetParam(), {}, 3e-9, -1.0);
  EXPECT_EQ(behind.ticks, 0) << "of 400, " << behind.most << " m behind";
}

TEST_P(LeftBehind, NotWithFrictionByMoreThanItsCone) {
  Material wall;
  wall.stiffness = kDefaultK;
  wall.friction = {0.3, 0.2};
  // The proxy sticks up to a lag of 0.3 of the depth of 3 mm.
  const Behind behind = alongEdge(GetParam(), wall, 0.3 * 0.003 * (1.0 + 1e-6) + 1e-9, -1.0);
  EXPECT_EQ(behind.ticks, 0) << "of 400, " << behind.most << " m behind";
}

TEST_P(LeftBehind, NotOutsideABoxPressedBesideItsEdge) {
  // The proxy moves outside the box on the face x = 30 mm, along the edge, with the hand in the
  // plane of the top face.
  Drive drive(sceneOfSolid(box(Vec3(0.0), mm(60, 40, 20))));
  const double z = 0.010 - std::fabs(GetParam());
  (void)drive.to({0.033, -0.010, z});
  (void)drive.walk({0.028, -0.010, z});
  int behind = 0;
  for (int i = 1; i <= 400; ++i) {
    const double y = -0.010 + 0.05e-3 * i;
    const TickResult& tick = drive.to({0.028, y, z});
    // Either the face holds it, or it slipped over the edge to the hand: never in between.
    const bool is_held = glm::length(tick.proxy - Vec3(0.030, y, z)) <= 3e-9;
    const bool is_free = glm::length(tick.proxy - drive.hip()) <= 3e-9;
    behind += is_held || is_free ? 0 : 1;
  }
  EXPECT_EQ(behind, 0);
}

std::string asideName(const ::testing::TestParamInfo<double>& info) {
  return "case" + std::to_string(info.index);
}

// The hand is in the plane, or beyond or before it by an encoder's rounding.
INSTANTIATE_TEST_SUITE_P(Aside, LeftBehind,
                         ::testing::Values(0.0, 5e-11, -5e-11, 1e-13, -1e-13, 1e-16, -1e-16, 1e-9),
                         asideName);

TEST(LeftBehindInACorner, NotWhereTwoPlanesAreMet) {
  // The hand is in the planes of two faces at once; it goes into the corner and back out along the
  // third axis.
  Drive drive(sceneOfSolid(box(Vec3(0.0), mm(60, 40, 20)), true));
  (void)drive.to(Vec3(0.0));
  (void)drive.walk({0.028, 0.020, 0.010});
  for (const double goal : {0.034, 0.010, 0.030, 0.036, 0.0}) {
    const double from = drive.hip().x;
    const int steps = static_cast<int>(std::ceil(std::fabs(goal - from) / 1e-4));
    for (int i = 1; i <= steps; ++i) {
      const double x = from + (goal - from) * i / steps;
      const TickResult& tick = drive.to({x, 0.020, 0.010});
      ASSERT_TRUE(isNear(tick.proxy, {std::min(x, 0.030), 0.020, 0.010}, 3e-9)) << x;
    }
  }
}

TEST(LeftBehindAtARim, NotJustBeforeASharpEdgeWhoseFieldIsNotADistance) {
  // A cone shrunk by 1 mm, as one leaf: beyond its rim, whose angle is 60 degrees, the field is
  // that of the side alone.
  const double slope = std::sqrt(3.0);
  const FieldPtr solid = offset(cone(Vec3(0.0), Vec3(0.0, 0.0, 1.0), 0.010, 0.010 * slope), -0.001);
  const double rim = 0.010 - 3.0 * 0.001 / slope;
  const auto at = [](double radius, double angle, double z) {
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  ASSERT_NEAR(solid->value(at(rim, 0.0, 0.001)), 0.0, 1e-12);
  for (const double before : {1e-4, 1e-6, 1e-7, 1.6e-8, 1e-8}) {
    for (const double turn : {0.0, 0.01}) {
      Drive drive(sceneOfLeaf(solid, solid->featureSize()));
      (void)drive.to(at(0.006, 0.0, 0.0));
      (void)drive.walk(at(0.006, 0.0, 0.0012));
      // The base, which is at 1 mm, holds it until the hand is this far from the rim, ...
      (void)drive.walk(at(rim - before, 0.0, 0.0012), 1e-4);
      ASSERT_TRUE(isNear(drive.last().proxy, at(rim - before, 0.0, 0.001), 3e-9)) << before;
      // ... and then it goes over the rim to the hand.
      const TickResult& tick = drive.to(at(rim + 1e-4, turn, 0.0012));
      EXPECT_TRUE(tick.settled) << before << " m before the rim, turned by " << turn;
      EXPECT_TRUE(isNear(tick.proxy, drive.hip(), 3e-9)) << before << " " << turn;
    }
  }
}

}  // namespace
}  // namespace palpate::test
