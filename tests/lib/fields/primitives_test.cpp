#include "palpate/fields/primitives.h"

#include <gtest/gtest.h>

#include "support/field_contract.h"

namespace palpate::test {
namespace {

double square(double x) { return x * x; }

std::vector<FieldCase> primitiveCases() {
  std::vector<FieldCase> cases;
  const Vec3 tilt = glm::normalize(Vec3(1.0, -2.0, 0.5));

  cases.push_back({.name = "half_space",
                   .make = [] { return halfSpace(Vec3(0.01, 0.02, -0.03), Vec3(0, 0, 5.0)); },
                   .region = {Vec3(-0.1), Vec3(0.1)},
                   .inside = [](const Vec3& p) { return p.z < -0.03; }});
  cases.push_back({.name = "half_space_tilted",
                   .make = [=] { return halfSpace(Vec3(0.01, 0.02, -0.03), 1e-8 * tilt); },
                   .region = {Vec3(-0.1), Vec3(0.1)},
                   .inside =
                       [=](const Vec3& p) {
                         return (p.x - 0.01) - 2.0 * (p.y - 0.02) + 0.5 * (p.z + 0.03) < 0.0;
                       },
                   .sign_margin = 1e-10});

  for (const double radius : {0.05, 1e-6, 3.0}) {
    const Vec3 c(0.01, -0.02, 0.005);
    cases.push_back({.name = "sphere_" + std::to_string(std::lround(radius * 1e6)) + "um",
                     .make = [=] { return sphere(c, radius); },
                     .region = {c - Vec3(2.0 * radius), c + Vec3(2.0 * radius)},
                     .inside =
                         [=](const Vec3& p) {
                           return square(p.x - c.x) + square(p.y - c.y) + square(p.z - c.z) <
                                  radius * radius;
                         },
                     .awkward = {c, c + Vec3(radius, 0, 0), c + Vec3(1e-18, 0, 0)},
                     // At coordinates of 0.02 m a radius of 1 um is represented to 1e-12 of itself.
                     .sign_margin = 1e-9});
  }

  {
    const Vec3 c(0.01, -0.02, 0.005);
    const Vec3 size(0.1, 0.04, 0.06);
    cases.push_back(
        {.name = "box",
         .make = [=] { return box(c, size); },
         .region = {c - size, c + size},
         .inside =
             [=](const Vec3& p) {
               const Vec3 d = glm::abs(p - c);
               return 2 * d.x < size.x && 2 * d.y < size.y && 2 * d.z < size.z;
             },
         .awkward = {c, c + 0.5 * size, c + Vec3(0.05, 0.02, 0), c + Vec3(0.03, 0, 0)}});
    const Vec3 plate(0.2, 0.1, 1e-4);
    cases.push_back({.name = "box_plate",
                     .make = [=] { return box(Vec3(0.0), plate); },
                     .region = {Vec3(-0.15, -0.1, -1e-3), Vec3(0.15, 0.1, 1e-3)},
                     .inside =
                         [=](const Vec3& p) {
                           const Vec3 d = 2.0 * glm::abs(p);
                           return d.x < plate.x && d.y < plate.y && d.z < plate.z;
                         },
                     .awkward = {0.5 * plate, -0.5 * plate}});
  }

  struct Can {
    std::string name;
    Vec3 axis;
    double radius, height;
  };
  for (const Can& can :
       {Can{"cylinder", Vec3(0, 0, 1), 0.03, 0.08}, Can{"cylinder_tilted", tilt, 0.03, 0.08},
        Can{"cylinder_disc", tilt, 0.05, 0.001},
        Can{"cylinder_needle", Vec3(-3, 0, 0), 0.0005, 0.1}}) {
    const Vec3 c(0.01, -0.02, 0.005);
    const Vec3 a = glm::normalize(can.axis);
    const Vec3 along = 0.5 * can.height * a;
    const Vec3 extent = glm::abs(along) + Vec3(can.radius);
    cases.push_back({.name = can.name,
                     .make = [=] { return cylinder(c, can.axis, can.radius, can.height); },
                     .region = {c - 1.3 * extent, c + 1.3 * extent},
                     .inside =
                         [=](const Vec3& p) {
                           const Vec3 off = glm::cross(p - c, a);
                           return glm::dot(off, off) < square(can.radius) &&
                                  std::fabs(glm::dot(p - c, a)) < 0.5 * can.height;
                         },
                     .awkward = {c, c + along, c - along, c + 2.0 * along, c + 0.3 * along},
                     .sign_margin = 1e-11});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Primitives, FieldContract, testing::ValuesIn(primitiveCases()),
                         testing::PrintToStringParamName());

TEST(HalfSpace, LiesAgainstItsNormal) {
  const FieldPtr field = halfSpace(Vec3(0, 0, 0.015), Vec3(0, 0, 2));
  EXPECT_EQ(field->value(Vec3(7, -3, 0.025)), 0.025 - 0.015);
  EXPECT_LT(field->value(Vec3(0, 0, 0)), 0.0);
  EXPECT_EQ(field->bounds().hi.z, 0.015);
  EXPECT_EQ(field->bounds().lo.z, -kInfinity);
  EXPECT_EQ(field->bounds().hi.x, kInfinity);
}

TEST(Sphere, GradientAtTheCenterIsPlusX) {
  const FieldPtr field = sphere(Vec3(1, 2, 3), 0.5);
  const FieldSample s = field->sample(Vec3(1, 2, 3));
  EXPECT_EQ(s.value, -0.5);
  EXPECT_EQ(s.gradient, Vec3(1, 0, 0));
}

TEST(Sphere, KeepsItsDirectionWhereSquaresUnderAndOverflow) {
  const FieldPtr field = sphere(Vec3(0.0), 0.5);
  const Vec3 expected(0.6, 0.0, -0.8);
  for (const double scale : {5e-324, 1e-310, 1e-200, 1e-20, 1.0, 1e150, 1e200, 1e300}) {
    const FieldSample s = field->sample(scale * Vec3(3.0, 0.0, -4.0));
    EXPECT_LT(glm::length(s.gradient - expected), 1e-15) << scale;
    EXPECT_NEAR(s.value / (5.0 * scale - 0.5), 1.0, 1e-15) << scale;
  }
}

TEST(Box, HasEuclideanDistanceBeyondFacesEdgesAndCorners) {
  const FieldPtr field = box(Vec3(1, 1, 1), Vec3(2, 4, 6));
  EXPECT_EQ(field->value(Vec3(5, 1, 1)), 3.0);
  EXPECT_EQ(field->value(Vec3(5, 7, 1)), 5.0);  // 3-4-5 from the edge
  EXPECT_EQ(field->value(Vec3(3, 5, 6)), 3.0);  // 1-2-2 from the corner
  EXPECT_EQ(field->value(Vec3(1.5, 1, 1)), -0.5);
  EXPECT_EQ(field->sample(Vec3(1, 1, 1)).gradient, Vec3(1, 0, 0));
  EXPECT_EQ(field->bounds().lo, Vec3(0, -1, -2));
  EXPECT_EQ(field->bounds().hi, Vec3(2, 3, 4));
}

TEST(Cylinder, HasEuclideanDistanceBeyondWallCapAndRim) {
  const FieldPtr field = cylinder(Vec3(0, 0, 1), Vec3(0, 0, 3), 2.0, 4.0);
  EXPECT_EQ(field->value(Vec3(3, 0, 0)), 1.0);
  EXPECT_EQ(field->value(Vec3(1, 0, 5)), 2.0);
  EXPECT_EQ(field->value(Vec3(0, 5, 7)), 5.0);
  EXPECT_EQ(field->value(Vec3(0, 0, 1)), -2.0);
  EXPECT_EQ(field->bounds().lo, Vec3(-2, -2, -1));
  EXPECT_EQ(field->bounds().hi, Vec3(2, 2, 3));
}

}  // namespace
}  // namespace palpate::test
