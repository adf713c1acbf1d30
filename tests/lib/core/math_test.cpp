#include "palpate/core/math.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace palpate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A few roundings of numbers of order one.
constexpr double kRounding = 1e-14;

void expectNear(const Vec3& a, const Vec3& b, double tolerance = kRounding) {
  EXPECT_LE(glm::length(a - b), tolerance)
      << "(" << a.x << ", " << a.y << ", " << a.z << ") instead of (" << b.x << ", " << b.y << ", "
      << b.z << ")";
}

TEST(Math, IsFiniteSeesEveryComponent) {
  EXPECT_TRUE(isFinite(Vec3(1.0, -2.0, 1e300)));
  for (int i = 0; i < 3; ++i) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      Vec3 v(1.0);
      v[i] = bad;
      EXPECT_FALSE(isFinite(v));
    }
  }
}

TEST(Math, UnitOrNormalizesOrFallsBack) {
  const Vec3 fallback(0.0, 0.0, 1.0);
  expectNear(unitOr(Vec3(3.0, 0.0, 4.0), fallback), Vec3(0.6, 0.0, 0.8));
  for (const Vec3& none : {Vec3(0.0), Vec3(kNan, 0.0, 0.0), Vec3(kInfinity, 0.0, 0.0)}) {
    EXPECT_EQ(unitOr(none, fallback), fallback);
  }
}

TEST(Math, OuterIsAColumnTimesARow) {
  const Vec3 a(1.0, 2.0, 3.0);
  const Vec3 b(4.0, 5.0, 6.0);
  const Vec3 v(0.3, -0.2, 0.7);
  expectNear(outer(a, b) * v, a * glm::dot(b, v));
}

TEST(Box3, ADefaultBoxIsEmptyAndTakesTheFirstPointWhole) {
  Box3 box;
  EXPECT_TRUE(box.isEmpty());
  EXPECT_FALSE(box.isBounded());
  EXPECT_FALSE(box.contains(Vec3(0.0)));
  box.include(Vec3(1.0, 2.0, 3.0));
  EXPECT_FALSE(box.isEmpty());
  EXPECT_TRUE(box.isBounded());
  EXPECT_EQ(box.size(), Vec3(0.0));
  EXPECT_TRUE(box.contains(Vec3(1.0, 2.0, 3.0)));
}

TEST(Box3, EverythingHoldsAllAndIsNotBounded) {
  const Box3 all = Box3::everything();
  EXPECT_FALSE(all.isEmpty());
  EXPECT_FALSE(all.isBounded());
  EXPECT_TRUE(all.contains(Vec3(1e300, -1e300, 0.0)));
  EXPECT_EQ(all.distanceTo(Vec3(1e300)), 0.0);
}

TEST(Box3, UnionAndIntersection) {
  const Box3 a{Vec3(0.0), Vec3(2.0)};
  const Box3 b{Vec3(1.0, 1.0, -1.0), Vec3(3.0, 3.0, 1.0)};
  EXPECT_EQ(a.unitedWith(b).lo, Vec3(0.0, 0.0, -1.0));
  EXPECT_EQ(a.unitedWith(b).hi, Vec3(3.0, 3.0, 2.0));
  EXPECT_EQ(a.intersectedWith(b).lo, Vec3(1.0, 1.0, 0.0));
  EXPECT_EQ(a.intersectedWith(b).hi, Vec3(2.0, 2.0, 1.0));
  EXPECT_EQ(a.unitedWith(Box3()).lo, a.lo);
  EXPECT_TRUE(a.intersectedWith(Box3()).isEmpty());
  EXPECT_TRUE(a.intersectedWith({Vec3(5.0), Vec3(6.0)}).isEmpty());
}

TEST(Box3, GrownByMovesEveryFaceAndLeavesEmptyEmpty) {
  const Box3 a{Vec3(0.0), Vec3(2.0)};
  EXPECT_EQ(a.grownBy(0.5).lo, Vec3(-0.5));
  EXPECT_EQ(a.grownBy(0.5).hi, Vec3(2.5));
  EXPECT_TRUE(a.grownBy(-2.0).isEmpty());
  EXPECT_TRUE(Box3().grownBy(10.0).isEmpty());
}

TEST(Box3, DistanceToFaceEdgeCornerAndInside) {
  const Box3 a{Vec3(-1.0), Vec3(1.0)};
  EXPECT_EQ(a.distanceTo(Vec3(0.5, 0.0, 0.9)), 0.0);
  EXPECT_DOUBLE_EQ(a.distanceTo(Vec3(3.0, 0.0, 0.0)), 2.0);
  EXPECT_DOUBLE_EQ(a.distanceTo(Vec3(4.0, 5.0, 0.0)), 5.0);
  EXPECT_DOUBLE_EQ(a.distanceTo(Vec3(2.0, 3.0, -3.0)), 3.0);
}

TEST(Pose, InverseUndoesAndAfterComposes) {
  const Pose a{rotationAbout(Vec3(1.0, 2.0, -0.5), 0.7), Vec3(0.1, -0.2, 0.3)};
  const Pose b{rotationAbout(Vec3(0.0, 1.0, 3.0), -2.1), Vec3(-1.0, 0.5, 0.0)};
  const Vec3 p(0.4, -0.9, 1.3);
  expectNear(a.applyInverse(a.apply(p)), p);
  expectNear(a.after(b).apply(p), a.apply(b.apply(p)));
  expectNear(a.rotate(p), a.apply(p) - a.translation);
}

TEST(Pose, AMovedBoxIsTheTightBoxOfItsCorners) {
  const Pose pose{rotationAbout(Vec3(1.0, 1.0, 0.3), 1.1), Vec3(3.0, -2.0, 0.5)};
  const Box3 box{Vec3(-1.0, -2.0, 0.0), Vec3(0.5, 1.0, 4.0)};
  Box3 corners;
  for (int i = 0; i < 8; ++i) {
    corners.include(
        pose.apply(Vec3((i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y,
                        (i & 4) != 0 ? box.hi.z : box.lo.z)));
  }
  const Box3 moved = pose.apply(box);
  expectNear(moved.lo, corners.lo);
  expectNear(moved.hi, corners.hi);
}

TEST(Pose, AnInfiniteBoxStaysFreeOfNan) {
  const Pose pose{rotationAbout(Vec3(0.0, 0.0, 1.0), 0.5), Vec3(0.0)};
  const Box3 slab{Vec3(-kInfinity, -kInfinity, 0.0), Vec3(kInfinity, kInfinity, 1.0)};
  const Box3 moved = pose.apply(slab);
  EXPECT_EQ(moved.lo.x, -kInfinity);
  EXPECT_EQ(moved.hi.y, kInfinity);
  EXPECT_EQ(moved.lo.z, 0.0);
  EXPECT_EQ(moved.hi.z, 1.0);
  EXPECT_TRUE(pose.apply(Box3()).isEmpty());
}

TEST(RotationAbout, TurnsByTheRightHandRule) {
  const double quarter = std::numbers::pi / 2.0;
  expectNear(rotationAbout(Vec3(0.0, 0.0, 5.0), quarter) * Vec3(1.0, 0.0, 0.0),
             Vec3(0.0, 1.0, 0.0));
  expectNear(rotationAbout(Vec3(2.0, 0.0, 0.0), quarter) * Vec3(0.0, 1.0, 0.0),
             Vec3(0.0, 0.0, 1.0));
  expectNear(rotationAbout(Vec3(0.0, 1.0, 0.0), quarter) * Vec3(0.0, 0.0, 1.0),
             Vec3(1.0, 0.0, 0.0));
}

TEST(RotationAbout, IsARotationThatKeepsItsAxis) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-3.0, 3.0);
  for (int i = 0; i < 100; ++i) {
    const Vec3 axis(any(random), any(random), any(random));
    const double angle = any(random);
    const Mat3 r = rotationAbout(axis, angle);
    const Mat3 identity = glm::transpose(r) * r;
    for (int k = 0; k < 3; ++k) expectNear(identity[k], Mat3(1.0)[k]);
    EXPECT_NEAR(glm::dot(glm::cross(r[0], r[1]), r[2]), 1.0, kRounding);
    expectNear(r * axis, axis);
    EXPECT_NEAR(r[0][0] + r[1][1] + r[2][2], 1.0 + 2.0 * std::cos(angle), kRounding);
  }
}

}  // namespace
}  // namespace palpate
