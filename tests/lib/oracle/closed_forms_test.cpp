#include "support/oracle/closed_forms.h"

#include <gtest/gtest.h>

#include "lib/oracle/shapes.h"

namespace palpate::oracle {
namespace {

// All shapes are some tens of millimeters large.
constexpr double kSize = 0.05;

/// Checks that `x` is permitted, and that no permitted point nearby is nearer to `p`, both by
/// values alone.
void expectMinimum(const FeasibleSet& set, const Vec3& p, const Vec3& x, Random& random) {
  const double slack = 1e-12;  // rounding, at 0.1 m and a gradient of at most 100 1/m
  EXPECT_GE(set.value(x), -slack);
  const double depth = glm::length(x - p);
  for (const double radius : {1e-4 * kSize, 1e-6 * kSize}) {
    for (int i = 0; i < 300; ++i) {
      const Vec3 y = x + radius * random.unit();
      // A step r along a surface can gain only what rounding of the surface permits.
      if (set.value(y) >= 0.0) {
        EXPECT_GE(glm::length(y - p), depth - 1e-11);
      }
    }
  }
}

/// Checks that every permitted sample is at least as far from `p` as the nearest minimum.
void expectNearest(const FeasibleSet& set, const Vec3& p, const Minima& minima, Random& random) {
  ASSERT_FALSE(minima.empty());
  const double depth = glm::length(nearestTo(minima, p) - p);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 y = p + 2.0 * depth * random.real(0.0, 1.0) * random.unit();
    if (set.value(y) >= 0.0) {
      EXPECT_GE(glm::length(y - p), depth - 1e-12);
    }
  }
}

/// Both checks, for random points; `global`: the nearest minimum is the nearest permitted point.
template <typename Formula>
void tryOut(const FeasibleSet& set, const Formula& formula, double half, int least_contacts) {
  Random random;
  int contacts = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = random.inCube(half);
    const Minima minima = formula(p);
    if (set.value(p) >= 0.0) {
      ASSERT_EQ(minima.size(), 1U);
      EXPECT_EQ(minima[0], p);
      continue;
    }
    ++contacts;
    for (const Vec3& x : minima) expectMinimum(set, p, x, random);
    expectNearest(set, p, minima, random);
  }
  EXPECT_GE(contacts, least_contacts);
}

TEST(ClosedForms, Sphere) {
  const Vec3 center(0.01, -0.02, 0.005);
  const FieldPtr ball = ballField(center, kSize);
  tryOut(
      FeasibleSet::outside(ball),
      [&](const Vec3& p) { return sphereMinima(p, center, kSize, Held::kOutside); }, 0.08, 20);
  tryOut(
      FeasibleSet::inside(ball),
      [&](const Vec3& p) { return sphereMinima(p, center, kSize, Held::kInside); }, 0.2, 100);
  EXPECT_TRUE(sphereMinima(center, center, kSize, Held::kOutside).empty());
}

TEST(ClosedForms, Plane) {
  const Vec3 point(0.01, 0.0, 0.02);
  const Vec3 normal = glm::normalize(Vec3(1.0, 2.0, 3.0));
  tryOut(
      FeasibleSet::outside(planeField(point, normal, kSize)),
      [&](const Vec3& p) { return planeMinima(p, point, normal); }, 0.1, 50);
}

TEST(ClosedForms, Cylinder) {
  const Vec3 center(0.01, 0.0, 0.02);
  const Vec3 axis = glm::normalize(Vec3(1.0, -2.0, 0.5));
  const FieldPtr rod = rodField(center, axis, kSize);
  for (const Held held : {Held::kOutside, Held::kInside}) {
    tryOut(
        held == Held::kOutside ? FeasibleSet::outside(rod) : FeasibleSet::inside(rod),
        [&](const Vec3& p) { return cylinderMinima(p, center, axis, kSize, held); }, 0.1, 30);
  }
}

TEST(ClosedForms, Torus) {
  const Vec3 center(0.01, 0.0, 0.02);
  const Vec3 axis = glm::normalize(Vec3(1.0, -2.0, 0.5));
  const FieldPtr torus = torusField(center, axis, kSize, 0.4 * kSize);
  for (const Held held : {Held::kOutside, Held::kInside}) {
    tryOut(
        held == Held::kOutside ? FeasibleSet::outside(torus) : FeasibleSet::inside(torus),
        [&](const Vec3& p) { return torusMinima(p, center, axis, kSize, 0.4 * kSize, held); }, 0.07,
        20);
  }
}

TEST(ClosedForms, Box) {
  const Vec3 lo(-0.03, -0.02, -0.05);
  const Vec3 hi(0.04, 0.05, 0.03);
  tryOut(
      roomSet(lo, hi), [&](const Vec3& p) { return boxMinima(p, lo, hi, Held::kInside); }, 0.1,
      100);
  tryOut(
      aroundBoxSet(lo, hi), [&](const Vec3& p) { return boxMinima(p, lo, hi, Held::kOutside); },
      0.06, 20);
}

TEST(ClosedForms, Cone) {
  const Vec3 base(0.01, 0.0, -0.02);
  const Vec3 axis = glm::normalize(Vec3(1.0, -2.0, 0.5));
  for (const double degrees : {18.4, 45.0, 70.0}) {
    const double height = kSize;
    const double radius = height * std::tan(radians(degrees));
    const double slant = std::hypot(radius, height);
    const FieldPtr side = functionField(
        [=](const Vec3& p) {
          const double up = glm::dot(p - base, axis);
          const double flat = glm::length(p - base - up * axis);
          return (flat * height + (up - height) * radius) / slant;
        },
        kSize);
    using Set = FeasibleSet;
    tryOut(
        Set::allOf({Set::inside(side), Set::inside(planeField(base, -axis, kSize))}),
        [&](const Vec3& p) { return coneInside(p, base, axis, radius, height); }, 0.1, 50);
    // Beyond the tip, within the cone of its normals, the tip is nearest.
    const Vec3 tip = base + height * axis;
    EXPECT_NEAR(glm::length(coneInside(tip + 0.01 * axis, base, axis, radius, height)[0] - tip),
                0.0, 1e-16);
  }
}

TEST(ClosedForms, TwoBalls) {
  const Ball a{Vec3(-0.02, 0.0, 0.0), 0.04};
  const Ball b{Vec3(0.025, 0.01, -0.005), 0.03};
  const FieldPtr sa = ballField(a.center, a.radius);
  const FieldPtr sb = ballField(b.center, b.radius);
  using Set = FeasibleSet;
  tryOut(
      Set::allOf({Set::outside(sa), Set::outside(sb)}),
      [&](const Vec3& p) { return twoBallUnionOutside(p, a, b); }, 0.05, 50);
  tryOut(
      Set::allOf({Set::inside(sa), Set::inside(sb)}),
      [&](const Vec3& p) { return lensInside(p, a, b); }, 0.08, 100);
  tryOut(
      Set::anyOf({Set::outside(sa), Set::outside(sb)}),
      [&](const Vec3& p) { return lensOutside(p, a, b); }, 0.025, 20);
}

TEST(ClosedForms, TheCreaseOfTwoBallsIsFound) {
  const Ball a{Vec3(-0.02, 0.0, 0.0), 0.04};
  const Ball b{Vec3(0.02, 0.0, 0.0), 0.04};
  const Minima minima = twoBallUnionOutside(Vec3(0.0, 0.03, 0.0), a, b);
  ASSERT_EQ(minima.size(), 1U);
  EXPECT_NEAR(glm::length(minima[0] - Vec3(0.0, std::sqrt(0.0012), 0.0)), 0.0, 1e-16);
}

TEST(ClosedForms, GrooveAndFold) {
  const Vec3 point(0.005, 0.01, -0.01);
  for (const double degrees : {10.0, 60.0, 90.0, 135.0, 170.0}) {
    // Planes through the x axis, each tilted from the vertical by half the opening angle.
    const double half = radians(0.5 * degrees);
    const Vec3 n1(0.0, std::cos(half), std::sin(half));
    const Vec3 n2(0.0, -std::cos(half), std::sin(half));
    EXPECT_NEAR(glm::dot(n1, n2), -std::cos(radians(degrees)), 1e-15);
    const FieldPtr f1 = planeField(point, n1, kSize);
    const FieldPtr f2 = planeField(point, n2, kSize);
    using Set = FeasibleSet;
    tryOut(
        Set::allOf({Set::outside(f1), Set::outside(f2)}),
        [&](const Vec3& p) { return grooveMinima(p, point, n1, n2); }, 0.05, 50);
    tryOut(
        Set::anyOf({Set::outside(f1), Set::outside(f2)}),
        [&](const Vec3& p) { return foldMinima(p, point, n1, n2); }, 0.05, 0);
  }
}

TEST(ClosedForms, EllipsoidAgainstAMadeUpFoot) {
  // From a surface point along its normal in both directions, up to the smallest radius of
  // curvature: the closest point must be the starting point.
  Random random;
  const Vec3 radii(0.05, 0.02, 0.03);
  const double reach = 0.02 * 0.02 / 0.05;
  for (int i = 0; i < 500; ++i) {
    const Vec3 x = radii * random.unit();
    const Vec3 normal = glm::normalize(x / (radii * radii));
    for (const double height : {-0.95 * reach, -1e-3, -1e-6, 1e-6, 1e-3, 0.1}) {
      const Vec3 p = x + height * normal;
      // P is rounded at 0.05 m, and its foot moves 1 / (1 - 0.95) times as far.
      EXPECT_LT(glm::length(closestOnEllipsoid(p, radii) - x), 1e-15) << i << " " << height;
    }
  }
}

TEST(ClosedForms, EllipsoidInItsSymmetryPlanesAndCenter) {
  Random random;
  const Vec3 radii(0.05, 0.02, 0.03);
  const FeasibleSet around = FeasibleSet::outside(ellipsoidField(radii, 0.008));
  for (const Vec3& p : {Vec3(0.0), Vec3(0.01, 0.0, 0.0), Vec3(0.049, 0.0, 0.0),
                        Vec3(0.01, 0.0, 0.01), Vec3(0.0, 0.001, 0.0), Vec3(0.0, 0.0, 0.01)}) {
    const Vec3 x = closestOnEllipsoid(p, radii);
    const Vec3 q = x / radii;
    EXPECT_NEAR(glm::dot(q, q), 1.0, 1e-15);
    expectNearest(around, p, {x}, random);
  }
  EXPECT_NEAR(glm::length(closestOnEllipsoid(Vec3(0.0), radii)), 0.02, 1e-17);
  EXPECT_NEAR(glm::length(closestOnEllipsoid(Vec3(0.0, 0.0, 0.01), Vec3(0.03))), 0.03, 1e-17);
}

}  // namespace
}  // namespace palpate::oracle
