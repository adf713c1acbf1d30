// The measurements of `palpate accuracy`, on fields whose errors are known in advance.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accuracy/compare.h"
#include "accuracy/points.h"
#include "accuracy/truth.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "support/implicit_ellipsoid.h"

namespace palpate::tools {
namespace {

using testing::implicitEllipsoid;

constexpr double kVoxel = 0.5e-3;
const Vec3 kCenter(0.3e-3, -0.2e-3, 0.1e-3);

PointSet aroundTheBall(std::size_t count, double radius = 10e-3) {
  return pointsNear(Truth(sphere(kCenter, radius)), kVoxel, count, kVoxel);
}

TEST(AccuracyMeasure, AFieldAgainstItselfHasNoError) {
  const FieldPtr ball = sphere(kCenter, 10e-3);
  const Errors errors = errorsAt(*ball, aroundTheBall(2000).points, true);
  EXPECT_EQ(errors.points, 2000U);
  EXPECT_EQ(errors.out_of_band, 0U);
  EXPECT_EQ(errors.value.most, 0.0);
  EXPECT_EQ(errors.curvature.most, 0.0);
  EXPECT_LT(errors.normal.most, 1e-13);  // rounding of the unit normal
}

TEST(AccuracyMeasure, AnOffsetShowsAsThatOffset) {
  // The ball grown by 0.01 mm: the same normals and parallel surfaces, but other values.
  const FieldPtr grown = sphere(kCenter, 10.01e-3);
  const Errors errors = errorsAt(*grown, aroundTheBall(2000).points, true);
  EXPECT_NEAR(errors.value.rms, 0.01e-3, 1e-15);
  EXPECT_NEAR(errors.value.most, 0.01e-3, 1e-15);
  EXPECT_LT(errors.normal.most, 1e-13);
  EXPECT_LT(errors.curvature.most, 1e-9);
}

TEST(AccuracyMeasure, ATiltShowsInDegrees) {
  const double tilt = 0.5 * std::numbers::pi / 180.0;
  const FieldPtr plane = halfSpace(Vec3(0.0), Vec3(std::sin(tilt), 0.0, std::cos(tilt)));
  std::vector<JudgedPoint> points;
  for (int i = 0; i < 10; ++i) {
    points.push_back({Vec3(0.0, 1e-3 * i, 0.0), {0.0, Vec3(0.0, 0.0, 1.0), 0.0}, true});
  }
  points.push_back({Vec3(1.0), {7.0, Vec3(1.0, 0.0, 0.0), 3.0}, false});  // of the other kind
  const Errors errors = errorsAt(*plane, points, true);
  EXPECT_EQ(errors.points, 10U);
  EXPECT_NEAR(errors.normal.rms, 0.5, 1e-12);
  EXPECT_NEAR(errors.normal.most, 0.5, 1e-12);
  EXPECT_EQ(errorsAt(*plane, points, false).points, 1U);
}

TEST(AccuracyMeasure, ABentSurfaceShowsItsCurvature) {
  // A ball of 10 mm in place of a plane: 1 / (10 mm) too much curvature.
  std::vector<JudgedPoint> points = {
      {kCenter + Vec3(10e-3, 0.0, 0.0), {0.0, Vec3(1.0, 0.0, 0.0), 0.0}, true}};
  const Errors errors = errorsAt(*sphere(kCenter, 10e-3), points, true);
  EXPECT_NEAR(errors.curvature.rms, 100.0, 1e-9);
}

TEST(AccuracyMeasure, ImplicitValuesAreDividedByTheirSlopeIfAsked) {
  const FieldPtr ball = implicitEllipsoid(kCenter, Vec3(10e-3));
  const PointSet set = pointsNear(Truth(ball), 0.1e-3, 500, 0.1e-3);
  // To second order, S / |grad S| of (r / R)^2 - 1 has an error of d^2 / (2 R).
  const Errors errors = errorsAt(*ball, set.points, true, ValueIs::kOverSlope);
  EXPECT_GT(errors.value.most, 0.4e-6);
  EXPECT_LT(errors.value.most, 0.52e-6);
  EXPECT_GT(errorsAt(*ball, set.points, true).value.most, errors.value.most);
}

TEST(AccuracyPoints, LieEvenlyInTheBandAndAreTheSameEveryTime) {
  const PointSet set = aroundTheBall(4000);
  ASSERT_EQ(set.points.size(), 4000U);
  EXPECT_EQ(set.without_truth, 0U);
  int outside = 0, above = 0;
  for (const JudgedPoint& point : set.points) {
    const double distance = glm::length(point.at - kCenter) - 10e-3;
    ASSERT_LE(std::fabs(distance), kVoxel);
    ASSERT_NEAR(point.truth.value, distance, 1e-17);
    EXPECT_TRUE(point.smooth);
    outside += distance > 0.0 ? 1 : 0;
    above += point.at.z > kCenter.z ? 1 : 0;
  }
  // The outer half of the shell has slightly more volume, (10.5^3 - 10^3) / (10.5^3 - 9.5^3) =
  // 0.525; five standard deviations of 4000 draws are 0.04.
  EXPECT_NEAR(outside / 4000.0, 0.525, 0.04);
  EXPECT_NEAR(above / 4000.0, 0.5, 0.04);
  const PointSet again = aroundTheBall(4000);
  for (std::size_t i = 0; i < 4000; ++i) ASSERT_EQ(set.points[i].at, again.points[i].at);
}

TEST(AccuracyPoints, WhereThereIsNoSurfaceThereAreNone) {
  const FieldPtr empty = intersect({sphere(Vec3(0.0), 1e-3), sphere(Vec3(5e-3, 0.0, 0.0), 1e-3)});
  EXPECT_THROW((void)pointsNear(Truth(empty), 0.1e-3, 100, 0.1e-3), Error);
}

TEST(AccuracyPoints, StrokesFollowTheSurfaceStepByStep) {
  const Truth ball(sphere(kCenter, 10e-3));
  const auto strokes = strokesAlong(ball, aroundTheBall(10), 3, 200, 0.2e-3, kVoxel);
  ASSERT_EQ(strokes.size(), 3U);
  const double angle = std::atan2(0.2, 10.0);  // of one step, projected back onto the ball
  for (const Stroke& stroke : strokes) {
    ASSERT_EQ(stroke.points.size(), 200U);
    for (std::size_t i = 1; i < stroke.points.size(); ++i) {
      const Vec3 step = stroke.points[i].at - stroke.points[i - 1].at;
      ASSERT_NEAR(glm::length(step), 2.0 * 10e-3 * std::sin(0.5 * angle), 1e-12);
    }
  }
  // Along a great circle, three successive normals deviate from a straight line by 2 (1 - cos
  // angle).
  const Jitter jitter = jitterOf(*sphere(kCenter, 10e-3), strokes);
  EXPECT_EQ(jitter.points, 3U * 198U);
  for (const double found : {jitter.field.rms, jitter.field.most, jitter.truth.most}) {
    EXPECT_NEAR(found, 2.0 * (1.0 - std::cos(angle)), 1e-12);
  }
}

TEST(AccuracyTruth, TheFootOfAnImplicitFieldIsItsNearestPoint) {
  const Vec3 radii(9e-3, 6e-3, 7e-3);
  const FieldPtr exact = ellipsoid(kCenter, radii);
  const Truth truth(implicitEllipsoid(kCenter, radii));
  EXPECT_TRUE(truth.projects());
  const PointSet set = pointsNear(Truth(exact), 2e-3, 2000, 0.1e-3);
  for (const JudgedPoint& point : set.points) {
    const auto found = truth.at(point.at);
    ASSERT_TRUE(found);  // no center of curvature is nearer than 4 mm
    ASSERT_NEAR(found->value, point.truth.value, 1e-15);
    ASSERT_LT(glm::length(found->normal - point.truth.normal), 1e-10);
    // The exact field's Hessian comes from differences here, with an error of a millionth.
    ASSERT_NEAR(found->curvature, point.truth.curvature, 1e-4 * point.truth.curvature);
  }
}

TEST(AccuracyTruth, EdgesAndTightBendsAreToldFromSmoothParts) {
  const FieldPtr brick = box(Vec3(0.0), Vec3(40e-3));
  EXPECT_TRUE(isSmoothAround(*brick, Vec3(20e-3, 0.0, 0.0), 1e-3));
  EXPECT_TRUE(isSmoothAround(*brick, Vec3(20.3e-3, 11e-3, 0.0), 1e-3));
  EXPECT_FALSE(isSmoothAround(*brick, Vec3(20e-3, 18e-3, 0.0), 1e-3));    // the edge
  EXPECT_FALSE(isSmoothAround(*brick, Vec3(21e-3, 19.5e-3, 0.0), 1e-3));  // outside of it
  EXPECT_TRUE(isSmoothAround(*brick, Vec3(20e-3, 18e-3, 0.0), 0.25e-3));
  // A ball of 6 voxels is smooth, though its center is a medial axis; a ball of 1 voxel counts as a
  // corner.
  EXPECT_TRUE(isSmoothAround(*sphere(Vec3(0.0), 7e-3), Vec3(7e-3, 0.0, 0.0), 1e-3));
  EXPECT_FALSE(isSmoothAround(*sphere(Vec3(0.0), 1e-3), Vec3(1.5e-3, 0.2e-3, 0.0), 1e-3));
  // A crease of 4 degrees.
  const FieldPtr roof =
      intersect({halfSpace(Vec3(0.0), Vec3(0.0, 0.0, 1.0)),
                 halfSpace(Vec3(0.0), Vec3(std::sin(0.07), 0.0, std::cos(0.07)))});
  EXPECT_FALSE(isSmoothAround(*roof, Vec3(2e-3, 0.0, 0.0), 1e-3));
  EXPECT_TRUE(isSmoothAround(*roof, Vec3(9e-3, 0.0, 0.0), 1e-3));
}

TEST(AccuracyOrder, IsTheExponentOfTheErrors) {
  const std::vector<double> h = {2.0, 1.0, 0.5, 0.25};
  std::vector<double> error;
  for (const double size : h) error.push_back(3e-4 * std::pow(size, 3.5));
  EXPECT_NEAR(fittedOrder(h, error).value_or(0.0), 3.5, 1e-12);
  EXPECT_FALSE(fittedOrder(std::vector<double>{1.0}, std::vector<double>{1.0}));
  EXPECT_FALSE(fittedOrder(std::vector<double>{1.0, 1.0}, std::vector<double>{1.0, 2.0}));
  EXPECT_FALSE(fittedOrder(std::vector<double>{1.0, 0.5}, std::vector<double>{1.0, 0.0}));
}

}  // namespace
}  // namespace palpate::tools
