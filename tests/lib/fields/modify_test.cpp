#include <gtest/gtest.h>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

const Vec3 kSize(0.06, 0.05, 0.04);
const Vec3 kRadii(0.05, 0.02, 0.03);
const Pose kPose{rotationAbout(Vec3(1, 1, 0), 0.5), Vec3(0.01, 0, 0)};

FieldPtr body() { return box(Vec3(0.0), kSize); }
FieldPtr part() { return place(subtract({body(), sphere(Vec3(0.03, 0, 0), 0.02)}), kPose); }

bool inBox(const Vec3& p, const Vec3& size) {
  const Vec3 d = 2.0 * glm::abs(p);
  return d.x < size.x && d.y < size.y && d.z < size.z;
}
bool inGrownBox(const Vec3& p, double by) {
  const Vec3 out = glm::max(glm::abs(p) - 0.5 * kSize, Vec3(0.0));
  return glm::dot(out, out) < by * by;
}

std::vector<FieldCase> modifiedCases() {
  const Box3 region{Vec3(-0.08), Vec3(0.08)};
  std::vector<FieldCase> cases;
  cases.push_back({.name = "scaled_ellipsoid",
                   .make = [] { return scale(ellipsoid(Vec3(0.01, 0, 0), kRadii), 0.7); },
                   .region = region,
                   .inside =
                       [](const Vec3& p) {
                         const Vec3 q = (p / 0.7 - Vec3(0.01, 0, 0)) / kRadii;
                         return glm::dot(q, q) < 1.0;
                       }});
  cases.push_back({.name = "scaled_tree",
                   .make = [] { return scale(part(), 1.25); },
                   .region = region,
                   .inside =
                       [](const Vec3& p) {
                         const Vec3 q = kPose.applyInverse(p / 1.25);
                         return inBox(q, kSize) && glm::length(q - Vec3(0.03, 0, 0)) > 0.02;
                       }});
  cases.push_back({.name = "scaled_quadric",
                   .make =
                       [] {
                         return scale(
                             quadric(Vec3(0.0), {.xx = 1, .yy = 2, .zz = 3, .constant = -1}), 0.05);
                       },
                   .region = region,
                   .inside =
                       [](const Vec3& p) {
                         const Vec3 q = p / 0.05;
                         return q.x * q.x + 2 * q.y * q.y + 3 * q.z * q.z < 1.0;
                       }});
  cases.push_back({.name = "grown_box",
                   .make = [] { return offset(body(), 0.008); },
                   .region = region,
                   .inside = [](const Vec3& p) { return inGrownBox(p, 0.008); }});
  cases.push_back({.name = "shrunk_box",
                   .make = [] { return offset(body(), -0.008); },
                   .region = region,
                   .inside = [](const Vec3& p) { return inBox(p, kSize - Vec3(0.016)); }});
  cases.push_back({.name = "grown_union",
                   .make =
                       [] {
                         return offset(unite({body(), sphere(Vec3(0.04, 0, 0), 0.02)}), 0.008);
                       },
                   .region = region,
                   .inside =
                       [](const Vec3& p) {
                         return inGrownBox(p, 0.008) || glm::length(p - Vec3(0.04, 0, 0)) < 0.028;
                       }});
  cases.push_back(
      {.name = "grown_difference", .make = [] { return offset(part(), 0.004); }, .region = region});
  cases.push_back(
      {.name = "shell_of_box",
       .make = [] { return shell(body(), 0.003); },
       .region = region,
       .inside = [](const Vec3& p) { return inBox(p, kSize) && !inBox(p, kSize - Vec3(0.006)); }});
  cases.push_back({.name = "shell_of_ellipsoid",
                   .make = [] { return shell(ellipsoid(Vec3(0.0), kRadii), 0.002); },
                   .region = region});
  cases.push_back({.name = "shell_of_heart",
                   .make = [] { return shell(heart(Vec3(0.0), 0.06), 0.002); },
                   .region = region});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Modified, FieldContract, ::testing::ValuesIn(modifiedCases()),
                         ::testing::PrintToStringParamName());

TEST(Scale, KeepsTheTreeAndItsSharing) {
  const FieldPtr ball = sphere(Vec3(0.1, 0, 0), 0.05);
  const FieldPtr twice = scale(unite({ball, place(ball, kPose)}), 2.0);
  ASSERT_EQ(twice->structure().kind, FieldStructure::Kind::kUnion);
  const FieldPtr& first = twice->structure().operands[0];
  const FieldPtr& second = twice->structure().operands[1];
  ASSERT_EQ(second->structure().kind, FieldStructure::Kind::kTransform);
  EXPECT_EQ(second->structure().operands[0], first);
  EXPECT_EQ(second->structure().pose.translation, 2.0 * kPose.translation);
  EXPECT_NEAR(first->value(Vec3(0.2, 0.15, 0)), 0.05, 1e-16);
  EXPECT_EQ(first->featureSize(), 0.1);
  EXPECT_EQ(scale(body(), 2.0)->structure().operands.size(), 6U);
}

TEST(Offset, BoxesShrinkSharpAndGrowRound) {
  EXPECT_EQ(offset(body(), -0.001)->structure().kind, FieldStructure::Kind::kFaces);
  EXPECT_EQ(offset(body(), 0.001)->structure().kind, FieldStructure::Kind::kLeaf);
  EXPECT_EQ(offset(sphere(Vec3(0.0), 1.0), 0.25)->value(Vec3(2, 0, 0)), 0.75);
  EXPECT_EQ(offset(sphere(Vec3(0.0), 1.0), 0.25)->bounds().hi.x, 1.25);
  // A complement shrinks when its hole grows.
  EXPECT_NEAR(offset(complement(sphere(Vec3(0.0), 1.0)), 0.25)->value(Vec3(0.75, 0, 0)), 0.0,
              1e-16);
}

TEST(Offset, BoundsAreHonestWhereTheValueIsOnlyABound) {
  // Two half-spaces that meet at 5 degrees: the tip of the grown wedge moves much farther than the
  // offset.
  const double tilt = 0.0436;
  const FieldPtr wedge = intersect({halfSpace(Vec3(0.0), Vec3(std::sin(tilt), 0, std::cos(tilt))),
                                    halfSpace(Vec3(0.0), Vec3(std::sin(tilt), 0, -std::cos(tilt))),
                                    box(Vec3(-0.05, 0, 0), Vec3(0.2, 0.1, 0.1))});
  const FieldPtr grown = offset(wedge, 0.001);
  const Vec3 p(0.02, 0, 0);
  ASSERT_LT(grown->value(p), 0.0);
  EXPECT_TRUE(grown->bounds().contains(p));
}

TEST(Shell, KeepsTheOuterSurfaceAndShowsBothWalls) {
  const FieldPtr ball = sphere(Vec3(0.0), 1.0);
  const FieldPtr hollow = shell(ball, 0.1);
  EXPECT_EQ(hollow->value(Vec3(2, 0, 0)), 1.0);
  EXPECT_NEAR(hollow->value(Vec3(0.95, 0, 0)), -0.05, 1e-15);
  EXPECT_NEAR(hollow->value(Vec3(0.5, 0, 0)), 0.4, 1e-15);
  EXPECT_EQ(hollow->featureSize(), 0.1);
  EXPECT_EQ(hollow->structure().operands[0], ball);
  EXPECT_EQ(hollow->bounds().hi, ball->bounds().hi);
}

TEST(Modify, ChecksItsParameters) {
  EXPECT_THROW(static_cast<void>(scale(nullptr, 2.0)), Error);
  EXPECT_THROW(static_cast<void>(scale(body(), 0.0)), Error);
  EXPECT_THROW(static_cast<void>(scale(body(), -1.0)), Error);
  EXPECT_THROW(static_cast<void>(scale(body(), std::nan(""))), Error);
  EXPECT_THROW(static_cast<void>(offset(nullptr, 0.1)), Error);
  EXPECT_THROW(static_cast<void>(offset(body(), kInfinity)), Error);
  EXPECT_THROW(static_cast<void>(shell(body(), 0.0)), Error);
  EXPECT_EQ(offset(body(), 0.0)->value(Vec3(0.0)), body()->value(Vec3(0.0)));
}

}  // namespace
}  // namespace palpate::test
