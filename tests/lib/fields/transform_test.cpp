#include <gtest/gtest.h>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

const Pose kPose{rotationAbout(Vec3(1.0, 2.0, -0.5), 0.7), Vec3(0.02, -0.01, 0.03)};

std::vector<FieldCase> transformCases() {
  const Box3 region{kPose.translation - Vec3(0.07), kPose.translation + Vec3(0.07)};
  const Vec3 size(0.06, 0.03, 0.04);
  const Vec3 radii(0.05, 0.02, 0.03);
  std::vector<FieldCase> cases;
  cases.push_back({.name = "placed_box",
                   .make = [=] { return place(box(Vec3(0.0), size), kPose); },
                   .region = region,
                   .inside =
                       [=](const Vec3& p) {
                         const Vec3 d = 2.0 * glm::abs(glm::transpose(kPose.rotation) *
                                                       (p - kPose.translation));
                         return d.x < size.x && d.y < size.y && d.z < size.z;
                       },
                   .awkward = {kPose.translation, kPose.apply(0.5 * size)}});
  cases.push_back({.name = "placed_ellipsoid",
                   .make = [=] { return place(ellipsoid(Vec3(0.0), radii), kPose); },
                   .region = region,
                   .inside =
                       [=](const Vec3& p) {
                         const Vec3 q =
                             glm::transpose(kPose.rotation) * (p - kPose.translation) / radii;
                         return glm::dot(q, q) < 1.0;
                       },
                   .awkward = {kPose.translation, kPose.apply(Vec3(0.05, 0, 0))}});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Placed, FieldContract, testing::ValuesIn(transformCases()),
                         testing::PrintToStringParamName());

TEST(Place, MovesValueGradientAndBounds) {
  // A quarter turn about z, then 1 m along x: the box's long side now lies along y.
  const Pose pose{rotationAbout(Vec3(0, 0, 1), std::acos(0.0)), Vec3(1, 0, 0)};
  const FieldPtr field = place(box(Vec3(0.0), Vec3(4, 2, 2)), pose);
  EXPECT_NEAR(field->value(Vec3(1, 3, 0)), 1.0, 1e-15);
  EXPECT_NEAR(field->value(Vec3(3, 0, 0)), 1.0, 1e-15);
  EXPECT_LT(glm::length(field->sample(Vec3(1, 3, 0)).gradient - Vec3(0, 1, 0)), 1e-15);
  EXPECT_LT(glm::length(field->bounds().lo - Vec3(0, -2, -1)), 1e-15);
  EXPECT_LT(glm::length(field->bounds().hi - Vec3(2, 2, 1)), 1e-15);
}

TEST(Place, ShowsOperandAndPose) {
  const FieldPtr body = box(Vec3(0.0), Vec3(1.0));
  const FieldPtr placed = place(body, kPose);
  const FieldStructure structure = placed->structure();
  ASSERT_EQ(structure.kind, FieldStructure::Kind::kTransform);
  ASSERT_EQ(structure.operands.size(), 1U);
  EXPECT_EQ(structure.operands[0], body);
  EXPECT_EQ(structure.pose.translation, kPose.translation);
}

TEST(Place, RoundedRotationsAreMadeExact) {
  Pose pose = kPose;
  pose.rotation[0] *= 1.0 + 4e-10;
  const Mat3 r = place(sphere(Vec3(0.0), 1.0), pose)->structure().pose.rotation;
  const Mat3 defect = glm::transpose(r) * r - Mat3(1.0);
  for (int i = 0; i < 3; ++i) EXPECT_LT(glm::length(defect[i]), 1e-15);
}

TEST(Place, RefusesWhatIsNotRigid) {
  const FieldPtr ball = sphere(Vec3(0.0), 1.0);
  Pose scaled;
  scaled.rotation = Mat3(1.001);
  Pose mirrored;
  mirrored.rotation[2][2] = -1.0;
  Pose broken;
  broken.rotation[1][0] = std::nan("");
  for (const Pose& pose : {scaled, mirrored, broken}) {
    try {
      static_cast<void>(place(ball, pose));
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_EQ(error.problem().code, "field.not_rigid");
    }
  }
  EXPECT_THROW(static_cast<void>(place(nullptr, kPose)), Error);
  EXPECT_THROW(static_cast<void>(place(ball, {Mat3(1.0), Vec3(kInfinity, 0, 0)})), Error);
}

}  // namespace
}  // namespace palpate::test
