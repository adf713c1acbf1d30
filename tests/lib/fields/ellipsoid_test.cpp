// The closest point of an ellipsoid, against closed forms at all proportions.

#include <gtest/gtest.h>

#include <algorithm>

#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

std::vector<FieldCase> ellipsoidCases() {
  struct Shape {
    std::string name;
    Vec3 radii;
  };
  std::vector<FieldCase> cases;
  for (const Shape& shape :
       {Shape{"sphere", Vec3(0.04)},
        Shape{"almost_sphere", Vec3(0.04, 0.04 * (1 + 1e-15), 0.04 * (1 - 1e-12))},
        Shape{"triaxial", Vec3(0.05, 0.02, 0.03)}, Shape{"oblate", Vec3(0.05, 0.01, 0.05)},
        Shape{"prolate", Vec3(0.01, 0.01, 0.06)}, Shape{"lens", Vec3(0.05, 0.05, 0.002)}}) {
    const Vec3 c(0.003, -0.02, 0.01);
    const Vec3 e = shape.radii;
    cases.push_back(
        {.name = "ellipsoid_" + shape.name,
         .make = [=] { return ellipsoid(c, e); },
         .region = {c - 1.8 * e, c + 1.8 * e},
         .inside =
             [=](const Vec3& p) {
               const Vec3 q = (p - c) / e;
               return glm::dot(q, q) < 1.0;
             },
         .awkward = {c, c + Vec3(e.x, 0, 0), c - Vec3(0, e.y, 0), c + Vec3(0, 0, 0.5 * e.z),
                     c + Vec3(0.3 * e.x, 0.2 * e.y, 0), c + Vec3(0, 0.9 * e.y, -0.1 * e.z)},
         .sign_margin = 1e-11});
    // The face that contact holds: the same surface as a cheaper field.
    FieldCase face = cases.back();
    face.name += "_face";
    face.make = [=] { return ellipsoid(c, e)->structure().operands.front(); };
    cases.push_back(std::move(face));
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Ellipsoids, FieldContract, testing::ValuesIn(ellipsoidCases()),
                         testing::PrintToStringParamName());

/// A point of the surface and the outward unit normal there.
struct SurfacePoint {
  Vec3 x, n;
  double reach_inside;  ///< [m] smallest radius of curvature there
};

SurfacePoint surfacePoint(const Vec3& e, const Vec3& u) {
  // u on the unit sphere is mapped to the surface by e, and to the normal by 1/e.
  const Vec3 x = e * u;
  const Vec3 w = u / e;
  // No curvature of the ellipsoid exceeds |1/e^2|max / |x/e^2|.
  const double least = std::min({e.x, e.y, e.z});
  return {x, glm::normalize(w), glm::length(w) * least * least};
}

TEST(Ellipsoid, IsAccurateToRoundingAtEveryProportion) {
  Random random(3);
  for (const double thin : {1.0, 0.999999, 0.5, 0.1, 1e-2, 1e-3, 1e-4}) {
    for (const double middle : {1.0, 0.7, thin}) {
      const Vec3 e(1.0, thin, middle);
      const FieldPtr field = ellipsoid(Vec3(0.0), e);
      for (int i = 0; i < 2000; ++i) {
        const SurfacePoint s = surfacePoint(e, random.direction());
        // Inside, x is the closest point only down to this depth.
        const double outside = std::pow(10.0, random.uniform(-6.0, 3.0));
        const double d = i % 2 == 0 ? outside : -random.uniform(0.0, 0.99) * s.reach_inside;
        const FieldSample got = field->sample(s.x + d * s.n);
        // The tolerance is 1e-14 of the larger of size and distance.
        const double scale = std::max(1.0, std::fabs(d));
        EXPECT_NEAR(got.value, d, 1e-14 * scale) << thin << ' ' << middle;
        // The position itself is rounded; where the surface is strongly curved, that turns the
        // normal.
        const double turn =
            4e-16 * scale / std::max(s.reach_inside * 0.01, std::fabs(d + s.reach_inside));
        EXPECT_LT(glm::length(got.gradient - s.n), 1e-14 + turn)
            << thin << ' ' << middle << ' ' << d;
      }
    }
  }
}

TEST(Ellipsoid, IsASphereWhenItsRadiiAreEqual) {
  const FieldPtr field = ellipsoid(Vec3(0.1, 0.2, 0.3), Vec3(0.04));
  const FieldPtr ball = sphere(Vec3(0.1, 0.2, 0.3), 0.04);
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random.in({Vec3(0.0), Vec3(0.4)});
    EXPECT_NEAR(field->value(p), ball->value(p), 3e-16);
    EXPECT_LT(glm::length(field->sample(p).gradient - ball->sample(p).gradient), 1e-15);
  }
  EXPECT_NEAR(field->value(Vec3(0.1, 0.2, 0.3)), -0.04, 1e-17);
}

TEST(Ellipsoid, MeetsClosedFormsOnItsAxes) {
  // On the long axis of an ellipse with half-axes a > b, inside |x| < (a^2 - b^2) / a, the closest
  // points leave the axis: distance b sqrt(1 - x^2 / (a^2 - b^2)). Beyond, it is the apex.
  const double a = 0.05, b = 0.02;
  const FieldPtr field = ellipsoid(Vec3(0.0), Vec3(a, b, b));
  for (const double x : {0.0, 0.001, 0.02, 0.0419, 0.041999999}) {
    EXPECT_NEAR(field->value(Vec3(x, 0, 0)), -b * std::sqrt(1.0 - x * x / (a * a - b * b)), 1e-16)
        << x;
    EXPECT_NEAR(field->value(Vec3(-x, 0, 0)), -b * std::sqrt(1.0 - x * x / (a * a - b * b)), 1e-16)
        << x;
  }
  // 0.042 is the focal point itself, where the direction is least certain.
  for (const double x : {0.042, 0.0421, 0.049, 0.05, 0.06, 5.0}) {
    EXPECT_NEAR(field->value(Vec3(x, 0, 0)), x - a, 2e-16 * std::max(1.0, x)) << x;
    EXPECT_NEAR(field->sample(Vec3(x, 0, 0)).gradient.x, 1.0, 1e-14);
  }
  EXPECT_NEAR(field->value(Vec3(0, 0.01, 0)), -0.01, 1e-16);
  EXPECT_NEAR(field->value(Vec3(0, 0, -0.07)), 0.05, 1e-16);
}

TEST(Ellipsoid, IsContinuousAcrossItsMedialDisc) {
  const Vec3 e(0.05, 0.03, 0.0001);
  const FieldPtr field = ellipsoid(Vec3(0.0), e);
  Random random(8);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(random.uniform(-0.05, 0.05), random.uniform(-0.03, 0.03), 0.0);
    const double on = field->value(p);
    for (const double off : {1e-320, 1e-300, 1e-200, 1e-100, 1e-30, 1e-18}) {
      EXPECT_NEAR(field->value(p + Vec3(0, 0, off)), on, 1e-16) << off;
      EXPECT_NEAR(field->value(p - Vec3(0, 0, off)), on, 1e-16) << off;
      const FieldSample s = field->sample(p - Vec3(0, 0, off));
      EXPECT_NEAR(glm::length(s.gradient), 1.0, 1e-15);
      if (on < 0.0) {
        EXPECT_LE(s.gradient.z, 0.0);
      }
    }
  }
}

TEST(Ellipsoid, IsAPointSeenFromVeryFarAway) {
  const FieldPtr field = ellipsoid(Vec3(0.0), Vec3(0.03, 0.02, 0.01));
  for (const double away : {1e10, 1e30, 1e160, 1e300}) {
    const FieldJet jet = field->jet(Vec3(away, 0.0, 0.0));
    // The curvature of a distance is 1 over the distance, across the direction to the point.
    EXPECT_NEAR(jet.hessian[0][0] * away, 0.0, 1e-9) << away;
    EXPECT_NEAR(jet.hessian[1][1] * away, 1.0, 1e-9) << away;
    EXPECT_NEAR(jet.hessian[2][2] * away, 1.0, 1e-9) << away;
  }
}

}  // namespace
}  // namespace palpate::test
