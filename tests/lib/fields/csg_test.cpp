#include "palpate/fields/csg.h"

#include <gtest/gtest.h>

#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

bool inBall(const Vec3& p, const Vec3& c, double r) { return glm::dot(p - c, p - c) < r * r; }
bool inBox(const Vec3& p, const Vec3& c, const Vec3& size) {
  const Vec3 d = 2.0 * glm::abs(p - c);
  return d.x < size.x && d.y < size.y && d.z < size.z;
}

const Vec3 kLeft(-0.02, 0, 0);
const Vec3 kRight(0.02, 0.005, 0);
const Vec3 kSize(0.06, 0.05, 0.04);

FieldPtr part() {
  return subtract({unite({box(Vec3(0.0), kSize), sphere(kRight, 0.03)}), sphere(kLeft, 0.025),
                   cylinder(Vec3(0.0), Vec3(0, 0, 1), 0.008, 1.0)});
}

std::vector<FieldCase> csgCases() {
  const Box3 region{Vec3(-0.07), Vec3(0.07)};
  const Vec3 lowest(0.0, 0.0, 0.01);
  std::vector<FieldCase> cases;
  cases.push_back(
      {.name = "union",
       .make =
           [] {
             return unite({sphere(kLeft, 0.03), sphere(kRight, 0.025)});
           },
       .region = region,
       .inside = [](const Vec3& p) { return inBall(p, kLeft, 0.03) || inBall(p, kRight, 0.025); },
       .awkward = {kLeft, kRight}});
  cases.push_back(
      {.name = "intersection",
       .make =
           [=] {
             return intersect({sphere(Vec3(0.0), 0.04), halfSpace(lowest, Vec3(0, 0, 1)),
                               box(Vec3(0.0), kSize)});
           },
       .region = region,
       .inside =
           [=](const Vec3& p) {
             return inBall(p, Vec3(0.0), 0.04) && p.z < lowest.z && inBox(p, Vec3(0.0), kSize);
           }});
  cases.push_back(
      {.name = "difference", .make = part, .region = region, .inside = [](const Vec3& p) {
         return (inBox(p, Vec3(0.0), kSize) || inBall(p, kRight, 0.03)) &&
                !inBall(p, kLeft, 0.025) && !(std::hypot(p.x, p.y) < 0.008 && std::fabs(p.z) < 0.5);
       }});
  cases.push_back({.name = "complement",
                   .make = [] { return complement(box(Vec3(0.0), kSize)); },
                   .region = region,
                   .inside =
                       [](const Vec3& p) {
                         const Vec3 d = 2.0 * glm::abs(p);
                         return d.x > kSize.x || d.y > kSize.y || d.z > kSize.z;
                       }});
  cases.push_back({.name = "complement_of_ellipsoid",
                   .make = [] { return complement(ellipsoid(Vec3(0.0), kSize)); },
                   .region = region,
                   .inside = [](const Vec3& p) { return glm::dot(p / kSize, p / kSize) > 1.0; }});
  cases.push_back({.name = "complement_twice",
                   .make = [] { return complement(complement(part())); },
                   .region = region});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Csg, FieldContract, testing::ValuesIn(csgCases()),
                         testing::PrintToStringParamName());

TEST(Csg, BoundsFollowTheOperands) {
  const FieldPtr body = box(Vec3(0.0), kSize);
  const FieldPtr hole = sphere(kLeft, 0.025);
  const Box3 bounds = subtract({body, hole})->bounds();
  EXPECT_EQ(bounds.lo, body->bounds().lo);
  EXPECT_EQ(bounds.hi, body->bounds().hi);
  EXPECT_EQ(unite({body, hole})->bounds().lo.x, kLeft.x - 0.025);
  EXPECT_FALSE(complement(body)->bounds().isBounded());
  // After two complements, or a complement of a part, the box is the original one.
  EXPECT_EQ(complement(complement(body))->bounds().hi, body->bounds().hi);
  EXPECT_EQ(complement(unite({complement(body), hole}))->bounds().hi, body->bounds().hi);
  EXPECT_TRUE(
      intersect({sphere(Vec3(-1, 0, 0), 0.1), sphere(Vec3(1, 0, 0), 0.1)})->bounds().isEmpty());
}

TEST(Csg, MetricIsABoundUnlessNothingIsCombined) {
  const FieldPtr ball = sphere(kLeft, 0.025);
  const FieldPtr body = box(Vec3(0.0), kSize);
  EXPECT_EQ(unite({ball, body})->metric(), Metric::kBound);
  EXPECT_EQ(intersect({ball, body})->metric(), Metric::kBound);
  EXPECT_EQ(complement(ball)->metric(), Metric::kExact);
  EXPECT_EQ(unite({ball}), ball);
  EXPECT_EQ(intersect({ball}), ball);
}

TEST(Csg, FeatureSizeIsTheSmallest) {
  const FieldPtr ball = sphere(kLeft, 0.025);
  const FieldPtr pin = cylinder(Vec3(0.0), Vec3(1, 0, 0), 0.001, 0.1);
  EXPECT_EQ(subtract({ball, pin})->featureSize(), pin->featureSize());
}

TEST(Csg, StructureShowsTheOperands) {
  using Kind = FieldStructure::Kind;
  const FieldPtr ball = sphere(kLeft, 0.025);
  const FieldPtr body = box(Vec3(0.0), kSize);
  EXPECT_EQ(ball->structure().kind, Kind::kLeaf);
  const FieldPtr difference = subtract({body, ball});
  ASSERT_EQ(difference->structure().kind, Kind::kIntersection);
  ASSERT_EQ(difference->structure().operands.size(), 2U);
  EXPECT_EQ(difference->structure().operands[0], body);
  const FieldPtr& cut = difference->structure().operands[1];
  ASSERT_EQ(cut->structure().kind, Kind::kComplement);
  EXPECT_EQ(cut->structure().operands[0], ball);
  EXPECT_EQ(unite({body, difference})->structure().kind, Kind::kUnion);
  // An operand that is itself a union stays one node, since a port may name it.
  const FieldPtr both = unite({body, ball});
  EXPECT_EQ(unite({both, body})->structure().operands[0], both);
}

TEST(Csg, FirstOperandCountsWhereTwoAreEqual) {
  // On the crease between two equal spheres the gradient is that of one of them, always the same
  // one.
  const FieldPtr pair = unite({sphere(Vec3(-0.01, 0, 0), 0.02), sphere(Vec3(0.01, 0, 0), 0.02)});
  EXPECT_GT(pair->sample(Vec3(0, 0.03, 0)).gradient.x, 0.0);
  EXPECT_GT(pair->jet(Vec3(0, 0.03, 0)).gradient.x, 0.0);
}

}  // namespace
}  // namespace palpate::test
