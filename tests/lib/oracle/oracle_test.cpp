#include "support/oracle/oracle.h"

#include <gtest/gtest.h>

#include "lib/oracle/shapes.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/oracle/closed_forms.h"

namespace palpate::oracle {
namespace {

// Differences of order 4 over 1e-3 of the feature size are good to about 1e-12; for a hand on a
// convex surface at 0.9 of its radius that error grows tenfold.
constexpr double kSolver = 1e-9;
// A cusp is found by a search over directions, which is exact to the square root of rounding.
constexpr double kSearch = 2e-6;

void expectProxy(const FeasibleSet& set, const Vec3& previous, const Vec3& hip, const Vec3& proxy,
                 double tolerance = kSolver) {
  const OracleResult result = solveOracle(set, previous, hip);
  EXPECT_TRUE(result.converged);
  EXPECT_FALSE(result.ambiguous);
  EXPECT_LE(result.errorOf(proxy, hip), tolerance)
      << "(" << result.proxy.x << ", " << result.proxy.y << ", " << result.proxy.z
      << ") instead of (" << proxy.x << ", " << proxy.y << ", " << proxy.z << ") for the hip ("
      << hip.x << ", " << hip.y << ", " << hip.z << ")";
}

TEST(Oracle, AFreeHipIsItsOwnProxy) {
  const FeasibleSet set = FeasibleSet::outside(ballField(Vec3(0.0), 0.05));
  const Vec3 hip(0.01, 0.02, 0.07);
  const OracleResult result = solveOracle(set, Vec3(0.0, 0.0, 0.1), hip);
  EXPECT_EQ(result.proxy, hip);
  EXPECT_TRUE(result.active.empty());
  EXPECT_TRUE(result.converged);
}

TEST(Oracle, ConvexSphereUpToNineTenthsDeep) {
  Random random;
  for (const double radius : {0.05, 0.0005}) {
    const Vec3 center(0.01, 0.02, -0.03);
    const FeasibleSet set = FeasibleSet::outside(ballField(center, radius));
    for (const double depth : {1e-4, 0.02, 0.5, 0.9}) {
      const Vec3 out = random.unit();
      const Vec3 hip = center + (1.0 - depth) * radius * out;
      // The proxy of the previous tick: slightly to the side.
      const Vec3 previous = center + radius * glm::normalize(out + 0.05 * random.unit());
      expectProxy(set, previous, hip, center + radius * out);
    }
  }
}

TEST(Oracle, HollowSphereDeeperThanItsRadius) {
  Random random;
  const FeasibleSet set = FeasibleSet::inside(ballField(Vec3(0.0), 0.01));
  for (const double depth : {0.1, 1.0, 2.5, 20.0}) {
    const Vec3 out = random.unit();
    const Vec3 previous = 0.01 * glm::normalize(out + 0.1 * random.unit());
    expectProxy(set, previous, 0.01 * (1.0 + depth) * out, 0.01 * out);
  }
}

TEST(Oracle, AProxyFarAroundASphereSlidesToItsFoot) {
  const FeasibleSet set = FeasibleSet::outside(ballField(Vec3(0.0), 0.05));
  expectProxy(set, Vec3(0.05, 0.0, 0.0), Vec3(-0.03, 0.04, 0.0) * 0.9, Vec3(-0.03, 0.04, 0.0));
}

TEST(Oracle, AProxyAboveAHipPastTheCenterRunsRoundToTheOtherSide) {
  // The point is stationary but not a minimum: only a second-order test makes the proxy leave it,
  // and it ends at an equivalent place in whichever direction it falls.
  const FeasibleSet set = FeasibleSet::outside(ballField(Vec3(0.0), 0.05));
  expectProxy(set, Vec3(0.0, 0.0, 0.05), Vec3(0.0, 0.0, -0.02), Vec3(0.0, 0.0, -0.05));
}

TEST(Oracle, ATieIsAmbiguous) {
  // The proxy is on top of a tall thin ellipsoid, pressed beyond the tip's center of curvature: it
  // falls to the left or right.
  const Vec3 radii(0.005, 0.012, 0.02);
  const FeasibleSet set = FeasibleSet::outside(ellipsoidField(radii, 0.00125));
  const OracleResult result = solveOracle(set, Vec3(0.0, 0.0, 0.02), Vec3(0.0, 0.0, 0.01));
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(result.ambiguous);
  EXPECT_GT(std::fabs(result.proxy.x), 0.003);
}

TEST(Oracle, PlaneAndCylinder) {
  Random random;
  const Vec3 point(0.01, 0.0, 0.02);
  const Vec3 normal = glm::normalize(Vec3(1.0, 2.0, 3.0));
  const Vec3 axis = glm::normalize(Vec3(3.0, 0.0, -1.0));
  const FeasibleSet plane = FeasibleSet::outside(planeField(point, normal, 0.05));
  const FieldPtr rod = rodField(point, axis, 0.02);
  for (int i = 0; i < 20; ++i) {
    const Vec3 step = 0.001 * random.unit();
    Vec3 hip = point + random.inCube(0.02);
    const Vec3 foot = planeMinima(hip, point, normal)[0];
    expectProxy(plane, foot + 0.1 * normal, hip, foot);

    for (const Held held : {Held::kOutside, Held::kInside}) {
      const Vec3 out = glm::normalize(glm::cross(axis, random.unit()));
      const double depth =
          held == Held::kOutside ? random.real(0.0, 0.018) : -random.real(0.0, 0.1);
      hip = point + (0.02 - depth) * out + random.real(-0.05, 0.05) * axis;
      const Vec3 x = cylinderMinima(hip, point, axis, 0.02, held)[0];
      expectProxy(held == Held::kOutside ? FeasibleSet::outside(rod) : FeasibleSet::inside(rod),
                  x + step, hip, x);
    }
  }
}

TEST(Oracle, Torus) {
  Random random;
  const Vec3 axis = glm::normalize(Vec3(0.2, 0.3, 1.0));
  const FieldPtr torus = torusField(Vec3(0.0), axis, 0.04, 0.015);
  for (int i = 0; i < 20; ++i) {
    const Vec3 ring = 0.04 * glm::normalize(glm::cross(axis, random.unit()));
    const Vec3 along = glm::normalize(glm::cross(axis, ring));
    const Vec3 out = glm::normalize(random.real(-1.0, 1.0) * glm::normalize(ring) +
                                    random.real(-1.0, 1.0) * axis + 1e-3 * along);
    const Vec3 hip = ring + random.real(0.2, 0.95) * 0.015 * out;
    const Vec3 x = torusMinima(hip, Vec3(0.0), axis, 0.04, 0.015, Held::kOutside)[0];
    expectProxy(FeasibleSet::outside(torus), x + 0.0005 * random.unit(), hip, x);
    // From inside the tube: the wall at the inner equator curves away, so the depth is limited by
    // its reach.
    const Vec3 far = ring + 0.015 * 1.5 * out;
    const Vec3 y = torusMinima(far, Vec3(0.0), axis, 0.04, 0.015, Held::kInside)[0];
    expectProxy(FeasibleSet::inside(torus), y - 0.0002 * out, far, y);
  }
}

TEST(Oracle, ImplicitEllipsoidWithinItsReach) {
  Random random;
  const Vec3 radii(0.05, 0.02, 0.03);
  const double reach = 0.02 * 0.02 / 0.05;
  const FieldPtr ellipsoid = ellipsoidField(radii, reach);
  for (int i = 0; i < 20; ++i) {
    const Vec3 foot = radii * random.unit();
    const Vec3 normal = glm::normalize(foot / (radii * radii));
    const Vec3 hip = foot - random.real(0.0, 0.9) * reach * normal;
    expectProxy(FeasibleSet::outside(ellipsoid), foot + 0.0003 * random.unit(), hip,
                closestOnEllipsoid(hip, radii));
    const Vec3 beyond = foot + random.real(0.0, 0.05) * normal;
    expectProxy(FeasibleSet::inside(ellipsoid), foot - 0.0003 * normal, beyond,
                closestOnEllipsoid(beyond, radii));
  }
}

TEST(Oracle, AGradientThatVariesAHundredTimesChangesNothing) {
  Random random;
  const FieldPtr ball = functionField(
      [](const Vec3& p) { return (glm::length(p) - 0.02) * std::exp(115.0 * p.x); }, 0.005);
  for (int i = 0; i < 20; ++i) {
    const Vec3 out = random.unit();
    const Vec3 previous = 0.02 * glm::normalize(out + 0.05 * random.unit());
    expectProxy(FeasibleSet::outside(ball), previous, 0.01 * out, 0.02 * out);
  }
}

TEST(Oracle, FacesEdgesAndCornersOfARoom) {
  Random random;
  const Vec3 lo(-0.03, -0.02, -0.05);
  const Vec3 hi(0.04, 0.05, 0.03);
  const FeasibleSet room = roomSet(lo, hi);
  for (int i = 0; i < 60; ++i) {
    const Vec3 hip = random.inCube(0.1);
    expectProxy(room, glm::clamp(random.inCube(0.1), lo, hi), hip, glm::clamp(hip, lo, hi));
  }
}

TEST(Oracle, ABoxFromOutsideHoldsItsFaceUntilTheHipLeavesSideways) {
  const Vec3 lo(-0.01);
  const Vec3 hi(0.01);
  const FeasibleSet around = aroundBoxSet(lo, hi);
  // Deep under the top, much nearer to the right face: the top still holds the proxy.
  expectProxy(around, Vec3(0.0, 0.0, 0.01), Vec3(0.009, 0.0, -0.005), Vec3(0.009, 0.0, 0.01));
  // The hand goes out through the right face: nothing holds the proxy any more.
  const Vec3 outside(0.012, 0.0, -0.005);
  expectProxy(around, Vec3(0.009, 0.0, 0.01), outside, outside);
}

TEST(Oracle, CreaseAndLensOfTwoBalls) {
  Random random;
  const Ball a{Vec3(-0.02, 0.0, 0.0), 0.04};
  const Ball b{Vec3(0.025, 0.01, -0.005), 0.03};
  const FieldPtr sa = ballField(a.center, a.radius);
  const FieldPtr sb = ballField(b.center, b.radius);
  const FeasibleSet around_union = FeasibleSet::outside(unite({sa, sb}));
  const FeasibleSet lens = FeasibleSet::inside(intersect({sa, sb}));
  const FeasibleSet around_lens = FeasibleSet::outside(intersect({sa, sb}));
  EXPECT_EQ(around_union.branches().size(), 1U);
  EXPECT_EQ(around_lens.branches().size(), 2U);
  int creases = 0;
  int rims = 0;
  for (int i = 0; i < 60; ++i) {
    Vec3 hip = random.inCube(0.04);
    const Minima outside = twoBallUnionOutside(hip, a, b);
    for (const Vec3& x : outside) {
      if (x == hip) continue;
      expectProxy(around_union, x, hip, x);
      creases += std::fabs(sa->value(x)) < 1e-12 && std::fabs(sb->value(x)) < 1e-12;
    }
    hip = random.inCube(0.06);
    const Vec3 x = lensInside(hip, a, b)[0];
    rims += std::fabs(sa->value(x)) < 1e-12 && std::fabs(sb->value(x)) < 1e-12;
    expectProxy(lens, Vec3(0.01, 0.0, 0.0), hip, x);

    hip = Vec3(0.01, 0.0, 0.0) + random.inCube(0.015);
    for (const Vec3& y : lensOutside(hip, a, b)) expectProxy(around_lens, y, hip, y);
  }
  EXPECT_GE(creases, 5);
  EXPECT_GE(rims, 5);
}

TEST(Oracle, GroovesOfAnyAngleAndFolds) {
  Random random;
  const Vec3 point(0.005, 0.01, -0.01);
  for (const double degrees : {10.0, 90.0, 170.0}) {
    const double half = radians(0.5 * degrees);
    const Vec3 n1(0.0, std::cos(half), std::sin(half));
    const Vec3 n2(0.0, -std::cos(half), std::sin(half));
    const FieldPtr f1 = planeField(point, n1, 0.05);
    const FieldPtr f2 = planeField(point, n2, 0.05);
    const FeasibleSet groove =
        FeasibleSet::allOf({FeasibleSet::outside(f1), FeasibleSet::outside(f2)});
    const FeasibleSet fold =
        FeasibleSet::anyOf({FeasibleSet::outside(f1), FeasibleSet::outside(f2)});
    for (int i = 0; i < 15; ++i) {
      const Vec3 hip = point + random.inCube(0.02);
      const Vec3 x = grooveMinima(hip, point, n1, n2)[0];
      expectProxy(groove, x, hip, x);
      expectProxy(groove, point + Vec3(0.0, 0.0, 0.02), hip, x);
      for (const Vec3& y : foldMinima(hip, point, n1, n2)) expectProxy(fold, y, hip, y);
    }
  }
}

TEST(Oracle, TransformsAndComplementsAreTakenApart) {
  const Pose pose{rotationAbout(Vec3(1.0, 1.0, 0.0), 0.8), Vec3(0.01, 0.02, 0.03)};
  const FieldPtr a = ballField(Vec3(0.0), 0.02);
  const FieldPtr half = planeField(Vec3(0.0), Vec3(0.0, 0.0, 1.0), 0.02);
  const FieldPtr bowl = place(subtract({a, half}), pose);  // the upper half of a ball
  const FeasibleSet around = FeasibleSet::outside(bowl);
  EXPECT_EQ(around.sides().size(), 2U);
  EXPECT_EQ(around.branches().size(), 2U);
  // Pressed from below onto the flat side, near the rim.
  const Vec3 hip = pose.apply(Vec3(0.015, 0.0, 0.001));
  const Vec3 x = pose.apply(Vec3(0.015, 0.0, 0.0));
  expectProxy(around, pose.apply(Vec3(0.014, 0.001, -0.001)), hip, x);
}

TEST(Oracle, FieldsThatTellTheirFacesAreTakenApart) {
  const FeasibleSet room = FeasibleSet::inside(box(Vec3(0.0), Vec3(0.02, 0.04, 0.03)));
  EXPECT_EQ(room.sides().size(), 6U);
  EXPECT_EQ(room.branches().size(), 1U);
  const Vec3 corner(0.01, 0.02, 0.015);
  const OracleResult result = solveOracle(room, Vec3(0.0), corner + Vec3(0.003, 0.005, 0.001));
  EXPECT_TRUE(result.smooth);
  EXPECT_LE(glm::length(result.proxy - corner), 1e-15);
  EXPECT_EQ(FeasibleSet::outside(box(Vec3(0.0), Vec3(1.0))).branches().size(), 6U);
}

TEST(Oracle, TheApexOfAHollowConeHolds) {
  // A funnel: the permitted points have a radius of at most z tan 40 degrees.
  const double slope = std::tan(radians(40.0));
  const FieldPtr cone =
      functionField([=](const Vec3& p) { return std::hypot(p.x, p.y) - slope * p.z; }, 0.01);
  const FeasibleSet funnel = FeasibleSet::inside(cone);
  const Vec3 hip(0.001, 0.0005, -0.005);
  const OracleResult result = solveOracle(funnel, Vec3(0.0, 0.0, 0.002), hip);
  EXPECT_TRUE(result.converged);
  EXPECT_FALSE(result.smooth);
  EXPECT_LE(result.errorOf(Vec3(0.0), hip), kSearch);
}

TEST(Oracle, TheCornerOfAKinkedBlackBoxHolds) {
  const Vec3 half(0.01, 0.02, 0.015);
  const FieldPtr box = functionField(
      [=](const Vec3& p) {
        const Vec3 d = glm::abs(p) - half;
        return std::max({d.x, d.y, d.z});
      },
      0.01);
  const FeasibleSet room = FeasibleSet::inside(box);
  const Vec3 hip(0.012, 0.024, 0.017);
  const OracleResult result = solveOracle(room, half - Vec3(1e-4, 2e-4, 1e-4), hip);
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.errorOf(half, hip), kSearch);
}

}  // namespace
}  // namespace palpate::oracle
