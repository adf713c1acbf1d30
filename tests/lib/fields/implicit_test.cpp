#include "palpate/fields/implicit.h"

#include <gtest/gtest.h>

#include <numbers>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

const Vec3 kCenter(0.01, -0.02, 0.005);

double gyroidFunction(const Vec3& p, double period) {
  const Vec3 q = (p - kCenter) * (2.0 * std::numbers::pi / period);
  return std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) +
         std::sin(q.z) * std::cos(q.x);
}

const std::vector<Metaball> kBalls{{Vec3(-0.012, 0, 0), 0.03, 1.0},
                                   {Vec3(0.016, 0.003, 0), 0.025, 0.8},
                                   {Vec3(0, 0.02, 0.004), 0.02, -0.5}};

double fallOff(FallOff kind, double q) {
  if (kind == FallOff::kWyvill) return q < 1.0 ? std::pow(1.0 - q * q, 3.0) : 0.0;
  return kind == FallOff::kGaussian ? std::exp(-q * q) : 1.0 / (1.0 + q * q);
}

std::vector<FieldCase> implicitCases() {
  std::vector<FieldCase> cases;
  {
    const double unit = 0.03 / 1.13901;
    cases.push_back(
        {.name = "heart",
         .make = [] { return heart(kCenter, 0.06); },
         .region = {kCenter - Vec3(0.04), kCenter + Vec3(0.04)},
         .inside =
             [=](const Vec3& p) {
               const Vec3 q = (p - kCenter) / unit;
               const double u = q.x * q.x + 2.25 * q.y * q.y + q.z * q.z - 1.0;
               return u * u * u < (q.x * q.x + q.y * q.y * 9.0 / 80.0) * q.z * q.z * q.z;
             },
         .awkward = {kCenter, kCenter + Vec3(0, 0, unit), kCenter - Vec3(0, 0, unit),
                     kCenter + Vec3(0, 0, 0.5 * unit)},
         // The rounded cusps differ from the sextic: near the axis by some hundredths of a unit.
         .sign_margin = 0.03});
  }
  struct Surface {
    std::string name;
    QuadricCoefficients q;
  };
  for (const Surface& s :
       {Surface{"ellipsoid", {.xx = 400, .yy = 900, .zz = 2500, .xy = 100, .x = 3, .constant = -1}},
        Surface{"cylinder", {.xx = 2500, .yy = 2500, .constant = -1}},
        Surface{"hyperboloid", {.xx = 2500, .yy = 1600, .zz = -900, .yz = 200, .constant = -1}},
        Surface{"cone", {.xx = 1, .yy = 1, .zz = -1}},
        Surface{"saddle", {.xx = 30, .yy = -20, .z = 1}},
        Surface{"paraboloid", {.xx = 30, .yy = 20, .x = 0.1, .z = 1}},
        Surface{"plane", {.x = 1, .y = 2, .z = 3, .constant = 0.01}},
        Surface{"two_planes", {.xx = 1e4, .constant = -1}}}) {
    const QuadricCoefficients q = s.q;
    cases.push_back({.name = "quadric_" + s.name,
                     .make = [=] { return quadric(kCenter, q, 0.2); },
                     .region = {kCenter - Vec3(0.08), kCenter + Vec3(0.08)},
                     .inside =
                         [=](const Vec3& p) {
                           const Vec3 d = p - kCenter;
                           return q.xx * d.x * d.x + q.yy * d.y * d.y + q.zz * d.z * d.z +
                                      q.xy * d.x * d.y + q.xz * d.x * d.z + q.yz * d.y * d.z +
                                      q.x * d.x + q.y * d.y + q.z * d.z + q.constant <
                                  0.0;
                         },
                     .awkward = {kCenter}});
  }
  cases.push_back({.name = "gyroid",
                   .make = [] { return gyroid(kCenter, 0.04); },
                   .region = {Vec3(-0.05), Vec3(0.05)},
                   .inside = [](const Vec3& p) { return gyroidFunction(p, 0.04) < 0.0; },
                   .awkward = {kCenter}});
  cases.push_back({.name = "gyroid_wall",
                   .make = [] { return gyroidWall(kCenter, 0.04, 0.003); },
                   .region = {Vec3(-0.05), Vec3(0.05)},
                   .inside =
                       [](const Vec3& p) {
                         const double slope = std::sqrt(3.0) * 2.0 * std::numbers::pi / 0.04;
                         return std::fabs(gyroidFunction(p, 0.04)) < 0.9 * 0.0015 * slope;
                       },
                   .awkward = {kCenter}});
  struct Kind {
    std::string name;
    FallOff fall_off;
    double iso;
  };
  for (const Kind& k :
       {Kind{"wyvill", FallOff::kWyvill, 0.3}, Kind{"gaussian", FallOff::kGaussian, 0.5},
        Kind{"inverse_square", FallOff::kInverseSquare, 0.9}}) {
    cases.push_back({.name = "metaballs_" + k.name,
                     .make = [=] { return metaballs(kBalls, k.fall_off, k.iso); },
                     .region = {Vec3(-0.06), Vec3(0.06)},
                     .inside =
                         [=](const Vec3& p) {
                           double sum = 0.0;
                           for (const Metaball& b : kBalls) {
                             sum += b.strength *
                                    fallOff(k.fall_off, glm::length(p - b.center) / b.radius);
                           }
                           return sum > k.iso;
                         },
                     .awkward = {kBalls[0].center, kBalls[1].center, Vec3(0.002, 0, 0)}});
  }
  cases.push_back(
      {.name = "user_function",
       .make =
           [] {
             return userField(
                 {.value = [](const Vec3& p) { return glm::length(p - kCenter) - 0.03; },
                  .bounds = {kCenter - Vec3(0.03), kCenter + Vec3(0.03)},
                  .feature_size = 0.03,
                  .metric = Metric::kExact});
           },
       .region = {Vec3(-0.06), Vec3(0.06)},
       .inside = [](const Vec3& p) { return glm::dot(p - kCenter, p - kCenter) < 0.03 * 0.03; },
       // At its kink the function itself has no gradient, and neither has 1e160 squared.
       .unit_gradient = false,
       .far_away = false});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Implicit, FieldContract, ::testing::ValuesIn(implicitCases()),
                         ::testing::PrintToStringParamName());

TEST(Heart, HasItsWidthAndIsUpright) {
  const double width = 0.06;
  const FieldPtr field = heart(Vec3(0.0), width);
  const double unit = 0.5 * width / 1.13901;
  // The rounded tip and dimple still lie where those of the sextic do.
  EXPECT_NEAR(field->value(Vec3(0, 0, unit)), 0.0, 1e-17);
  EXPECT_NEAR(field->value(Vec3(0, 0, -unit)), 0.0, 1e-17);
  EXPECT_LT(field->value(Vec3(0.5 * unit, 0, 1.1 * unit)), 0.0);
  EXPECT_GT(field->value(Vec3(0.5 * unit, 0, -1.0 * unit)), 0.0);
  double widest = 0.0;
  for (double z = 0.0; z < 1.2; z += 1e-3) {
    for (double x = 0.45 * width; x < 0.6 * width; x += 1e-6) {
      if (field->value(Vec3(x, 0, z * unit)) < 0.0) widest = std::max(widest, x);
    }
  }
  EXPECT_NEAR(2.0 * widest, width, 1e-4 * width + 2e-6);
}

TEST(Heart, HasAGradientEverywhereOnItsSurface) {
  const FieldPtr field = heart(Vec3(0.0), 0.06);
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 u = i % 2 == 0 ? random.direction()
                              : glm::normalize(Vec3(1e-3, 1e-3, 1.0) * random.direction());
    double near = 0.0;
    double far = 0.1;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (near + far);
      (field->value(u * middle) < 0.0 ? near : far) = middle;
    }
    EXPECT_GT(glm::length(field->sample(u * near).gradient), 0.3);
  }
}

TEST(Heart, FarAwayItDoesNotBend) {
  // Far away it is like a cone: the curvature is one over the distance, and 1e-100 m^-1 is rounded
  // to zero.
  const FieldPtr field = heart(kCenter, 0.06);
  for (const Vec3& p : {Vec3(1e100, 0, 0), Vec3(-1e120, 2e120, 1e119), Vec3(0, 0, 1e200)}) {
    const FieldJet jet = field->jet(p);
    EXPECT_EQ(jet.value, field->value(p));
    for (int c = 0; c < 3; ++c) EXPECT_LT(glm::length(jet.hessian[c]), 1e-90);
  }
}

TEST(Quadric, IsTheSameWhateverTheScaleOfItsCoefficients) {
  const QuadricCoefficients one{.xx = 4, .yy = 9, .zz = 1, .y = 0.2, .constant = -1};
  QuadricCoefficients big = one;
  for (double* c : {&big.xx, &big.yy, &big.zz, &big.y, &big.constant}) *c *= 1e200;
  const Vec3 p(0.3, -0.2, 0.1);
  EXPECT_NEAR(quadric(kCenter, big)->value(p), quadric(kCenter, one)->value(p), 1e-15);
}

TEST(Quadric, KnowsBoundsAndFeatureOfAnEllipsoid) {
  const FieldPtr field =
      quadric(kCenter, {.xx = 1 / 0.0025, .yy = 1 / 0.0004, .zz = 1 / 0.0009, .constant = -1});
  EXPECT_LT(glm::length(field->bounds().hi - (kCenter + Vec3(0.05, 0.02, 0.03))), 1e-12);
  EXPECT_NEAR(field->featureSize(), 0.02 * 0.02 / 0.05, 1e-12);
  EXPECT_FALSE(quadric(kCenter, {.xx = 1, .yy = 1, .constant = -1})->bounds().isBounded());
}

TEST(Quadric, RefusesWhatHasNoSurface) {
  for (const QuadricCoefficients& q :
       {QuadricCoefficients{}, QuadricCoefficients{.constant = -1},
        QuadricCoefficients{.xx = 1, .yy = 1, .zz = 1, .constant = 1},
        QuadricCoefficients{.xx = -1, .yy = -1, .constant = -1},
        QuadricCoefficients{.xx = 1, .y = std::nan("")}}) {
    EXPECT_THROW(static_cast<void>(quadric(kCenter, q)), Error);
  }
}

TEST(GyroidWall, IsAsThickAsToldToAnEighth) {
  const double thickness = 0.002;
  const FieldPtr wall = gyroidWall(kCenter, 0.04, thickness);
  const FieldPtr middle = gyroid(kCenter, 0.04);
  // No step of a search may be longer than a thin wall, or than an eighth of a period.
  EXPECT_EQ(wall->featureSize(), thickness);
  EXPECT_EQ(gyroidWall(kCenter, 0.04, 0.007)->featureSize(), 0.04 / 8.0);
  EXPECT_EQ(wall->structure().kind, FieldStructure::Kind::kIntersection);
  Random random(9);
  for (int i = 0; i < 500; ++i) {
    Vec3 p = random.in({Vec3(-0.04), Vec3(0.04)});
    for (int k = 0; k < 30; ++k) {
      const FieldSample s = middle->sample(p);
      p -= s.gradient * (s.value / std::max(0.1, glm::dot(s.gradient, s.gradient)));
    }
    if (std::fabs(middle->value(p)) > 1e-12) continue;
    const Vec3 n = glm::normalize(middle->sample(p).gradient);
    double across = 0.0;
    for (const double side : {-1.0, 1.0}) {
      double t = 0.0;
      while (wall->value(p + n * (side * t)) < 0.0) t += 1e-6;
      across += t;
    }
    EXPECT_NEAR(across / thickness, 1.0, 0.125);
  }
}

TEST(Metaballs, OneBallAloneIsASphere) {
  // (1 - q^2)^3 = 1/8 at q^2 = 1/2; exp(-q^2) = 1/e at q = 1; 1 / (1 + q^2) = 1/2 at q = 1.
  const Metaball ball{kCenter, 0.04, 1.0};
  const Vec3 u = glm::normalize(Vec3(1, 2, -3));
  EXPECT_NEAR(
      metaballs({ball}, FallOff::kWyvill, 0.125)->value(kCenter + 0.04 * std::sqrt(0.5) * u), 0.0,
      1e-16);
  EXPECT_NEAR(metaballs({ball}, FallOff::kGaussian, std::exp(-1.0))->value(kCenter + 0.04 * u), 0.0,
              1e-16);
  EXPECT_NEAR(metaballs({ball}, FallOff::kInverseSquare, 0.5)->value(kCenter + 0.04 * u), 0.0,
              1e-16);
}

TEST(Metaballs, LipschitzBoundDoesNotGrowWithBallsFarApart) {
  std::vector<Metaball> balls;
  for (int i = 0; i < 200; ++i) balls.push_back({Vec3(0.1 * i, 0, 0), 0.02, 1.0});
  // One ball contributes a slope of 1, the term outside the bounds another 1, and the search is
  // tight to a twentieth.
  EXPECT_LE(metaballs(balls, FallOff::kWyvill, 0.5)->lipschitz(), 2.06);
}

TEST(Metaballs, AreSmoothWhereTheSurfaceTouchesTheBounds) {
  // One ball alone touches each face of its bounds.
  const double radius = 0.04;
  const double step = 1e-9;
  for (const FallOff fall_off : {FallOff::kWyvill, FallOff::kGaussian, FallOff::kInverseSquare}) {
    const FieldPtr field = metaballs({{kCenter, radius, 1.0}}, fall_off, 0.5);
    const Box3 bounds = field->bounds();
    Random random(3);
    for (int i = 0; i < 600; ++i) {
      // Check across a face: at the place where the surface touches it, near that place, or
      // anywhere on the face or its plane beyond the edges.
      const int axis = i % 3;
      Vec3 p = i < 200   ? kCenter
               : i < 400 ? kCenter + random.in({Vec3(-1e-3), Vec3(1e-3)})
                         : random.in(bounds.grownBy(0.01));
      p[axis] = i % 2 == 0 ? bounds.hi[axis] : bounds.lo[axis];
      Vec3 to(0.0);
      to[axis] = step;
      const FieldJet below = field->jet(p - to);
      const FieldJet above = field->jet(p + to);
      // Twice the step times the curvature, which is below 4 / radius.
      ASSERT_LT(glm::length(above.gradient - below.gradient), 8.0 * step / radius);
      ASSERT_NEAR(above.value, below.value, 4.0 * step);
      if (i >= 400) continue;  // above an edge of the bounds the second derivatives jump
      for (int column = 0; column < 3; ++column) {
        // And twice the step times the third derivatives, below 100 / radius^2.
        ASSERT_LT(glm::length(above.hessian[column] - below.hessian[column]),
                  200.0 * step / (radius * radius));
      }
    }
    // The value rises outward everywhere around it.
    for (int i = 0; i < 1000; ++i) {
      const Vec3 u = random.direction();
      const double near = field->value(kCenter + 1.01 * bounds.size().x * u);
      const double far = field->value(kCenter + 2.0 * bounds.size().x * u);
      ASSERT_GT(near, 0.0);
      ASSERT_GT(far, near + 0.25 * bounds.size().x);
    }
  }
}

TEST(Metaballs, RefusesWhatCannotReachItsLevel) {
  EXPECT_THROW(static_cast<void>(metaballs({}, FallOff::kWyvill, 0.5)), Error);
  EXPECT_THROW(static_cast<void>(metaballs({{kCenter, 0.04, 0.4}}, FallOff::kWyvill, 0.5)), Error);
  EXPECT_THROW(static_cast<void>(metaballs({{kCenter, 0.04, 1.0}}, FallOff::kWyvill, 0.0)), Error);
  EXPECT_THROW(static_cast<void>(metaballs({{kCenter, -0.04, 1.0}}, FallOff::kWyvill, 0.5)), Error);
}

TEST(UserField, NeedsAFunctionAndAFeature) {
  EXPECT_THROW(static_cast<void>(userField({})), Error);
  EXPECT_THROW(static_cast<void>(userField({.value = [](const Vec3& p) { return p.x; }})), Error);
}

}  // namespace
}  // namespace palpate::test
