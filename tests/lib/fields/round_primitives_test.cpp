// Rounded box, cone, torus, capsule.

#include <gtest/gtest.h>

#include <algorithm>

#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

const Vec3 kCenter(0.01, -0.02, 0.005);
const Vec3 kTilt = glm::normalize(Vec3(1.0, -2.0, 0.5));

std::vector<FieldCase> roundCases() {
  std::vector<FieldCase> cases;
  const Vec3 size(0.1, 0.04, 0.06);
  for (const double r : {0.004, 0.02}) {  // the second one leaves a flat core
    cases.push_back({.name = r < 0.01 ? "rounded_box" : "rounded_box_to_the_middle",
                     .make = [=] { return roundedBox(kCenter, size, r); },
                     .region = {kCenter - size, kCenter + size},
                     .inside =
                         [=](const Vec3& p) {
                           const Vec3 out =
                               glm::max(glm::abs(p - kCenter) - (0.5 * size - Vec3(r)), Vec3(0.0));
                           return glm::dot(out, out) < r * r;
                         },
                     .awkward = {kCenter, kCenter + 0.5 * size, kCenter + Vec3(0.046, 0, 0)},
                     .sign_margin = 1e-11});
  }
  struct Pointed {
    std::string name;
    Vec3 axis;
    double radius, height;
  };
  for (const Pointed& c :
       {Pointed{"cone", Vec3(0, 0, 1), 0.03, 0.08}, Pointed{"cone_tilted_flat", kTilt, 0.05, 0.01},
        Pointed{"cone_needle", -kTilt, 0.001, 0.1}}) {
    const Vec3 a = glm::normalize(c.axis);
    const Vec3 tip = kCenter + c.height * a;
    Box3 region{kCenter - Vec3(1.3 * c.radius), kCenter + Vec3(1.3 * c.radius)};
    region.include(kCenter + 1.2 * c.height * a);
    cases.push_back({.name = c.name,
                     .make = [=] { return cone(kCenter, c.axis, c.radius, c.height); },
                     .region = region,
                     .inside =
                         [=](const Vec3& p) {
                           const double h = glm::dot(p - kCenter, a);
                           return h > 0.0 && glm::length(glm::cross(p - kCenter, a)) <
                                                 c.radius * (1.0 - h / c.height);
                         },
                     .awkward = {kCenter, tip, kCenter + 0.5 * c.height * a, tip + a, kCenter - a},
                     .sign_margin = 1e-11});
  }
  cases.push_back({.name = "torus",
                   .make = [] { return torus(kCenter, kTilt, 0.04, 0.012); },
                   .region = {kCenter - Vec3(0.06), kCenter + Vec3(0.06)},
                   .inside =
                       [](const Vec3& p) {
                         const Vec3 d = p - kCenter;
                         const double off = glm::length(glm::cross(d, kTilt)) - 0.04;
                         return std::hypot(off, glm::dot(d, kTilt)) < 0.012;
                       },
                   .awkward = {kCenter, kCenter + kTilt,
                               kCenter + 0.04 * glm::normalize(glm::cross(kTilt, Vec3(1, 0, 0)))},
                   .sign_margin = 1e-11});
  const Vec3 to = kCenter + 0.06 * kTilt;
  cases.push_back({.name = "capsule",
                   .make = [=] { return capsule(kCenter, to, 0.015); },
                   .region = {kCenter - Vec3(0.03, 0.09, 0.03), kCenter + Vec3(0.07, 0.03, 0.06)},
                   .inside =
                       [=](const Vec3& p) {
                         const double t = std::clamp(glm::dot(p - kCenter, kTilt), 0.0, 0.06);
                         return glm::length(p - kCenter - t * kTilt) < 0.015;
                       },
                   .awkward = {kCenter, to, 0.5 * (kCenter + to), to + kTilt},
                   .sign_margin = 1e-11});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Round, FieldContract, ::testing::ValuesIn(roundCases()),
                         ::testing::PrintToStringParamName());

TEST(RoundedBox, KeepsItsOuterSize) {
  const FieldPtr field = roundedBox(Vec3(0.0), Vec3(4, 6, 8), 1.0);
  EXPECT_EQ(field->value(Vec3(2, 0, 0)), 0.0);
  EXPECT_EQ(field->value(Vec3(0, -3, 1)), 0.0);
  EXPECT_NEAR(field->value(Vec3(2, 3, 0)), std::sqrt(2.0) - 1.0, 1e-15);
  EXPECT_EQ(field->bounds().hi, Vec3(2, 3, 4));
  EXPECT_THROW(static_cast<void>(roundedBox(Vec3(0.0), Vec3(4, 6, 8), 2.1)), Error);
}

TEST(Cone, HasEuclideanDistanceToSlantBaseTipAndRim) {
  const FieldPtr field = cone(Vec3(0.0), Vec3(0, 0, 1), 3.0, 4.0);
  EXPECT_EQ(field->value(Vec3(0, 0, 6)), 2.0);
  EXPECT_EQ(field->value(Vec3(1, 1, -2)), 2.0);
  EXPECT_EQ(field->value(Vec3(6, 0, -4)), 5.0);
  // These points lie on the normal (4, 3) / 5 through the middle of the slant.
  EXPECT_NEAR(field->value(Vec3(1.5 + 0.8, 0, 2 + 0.6)), 1.0, 1e-15);
  EXPECT_NEAR(field->value(Vec3(1.5 - 0.4, 0, 2 - 0.3)), -0.5, 1e-15);
  EXPECT_EQ(field->structure().kind, FieldStructure::Kind::kFaces);
  EXPECT_EQ(field->structure().operands.size(), 2U);
}

TEST(Torus, CurvesBothWaysAtItsInnerEquator) {
  const FieldPtr field = torus(Vec3(0.0), Vec3(0, 0, 1), 3.0, 1.0);
  const FieldJet jet = field->jet(Vec3(2, 0, 0));
  EXPECT_NEAR(jet.hessian[2][2], 1.0, 1e-14);
  EXPECT_NEAR(jet.hessian[1][1], -0.5, 1e-14);
  EXPECT_NEAR(jet.hessian[0][0], 0.0, 1e-14);
  EXPECT_THROW(static_cast<void>(torus(Vec3(0.0), Vec3(0, 0, 1), 1.0, 1.0)), Error);
}

TEST(Capsule, NeedsTwoDifferentEnds) {
  EXPECT_THROW(static_cast<void>(capsule(Vec3(1.0), Vec3(1.0), 1.0)), Error);
}

}  // namespace
}  // namespace palpate::test
