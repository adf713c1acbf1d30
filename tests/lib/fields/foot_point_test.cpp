// The nearest point of an implicit field's surface, against shapes whose distance is known.

#include "palpate/fields/foot_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"
#include "support/implicit_ellipsoid.h"

namespace palpate::test {
namespace {

using palpate::testing::implicitEllipsoid;

const Vec3 kCenter(0.3e-3, -0.2e-3, 0.1e-3);

TEST(FootPoint, OfAnEllipsoidIsItsNearestPoint) {
  const Vec3 radii(9e-3, 6e-3, 7e-3);
  const FieldPtr exact = ellipsoid(kCenter, radii);
  const FieldPtr implicit = implicitEllipsoid(kCenter, radii);
  Random random(11);
  int near = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 p = random.in(exact->bounds().grownBy(4e-3));
    const double distance = exact->value(p);
    if (distance < -2e-3) continue;  // no center of curvature is nearer than 6^2 / 9 = 4 mm
    ++near;
    const auto foot = footPoint(*implicit, p);
    ASSERT_TRUE(foot);
    ASSERT_NEAR(foot->distance, distance, 1e-15);
    ASSERT_LT(std::fabs(exact->value(foot->point)), 1e-15);
    ASSERT_LT(glm::length(foot->normal - exact->sample(p).gradient), 1e-10);
    ASSERT_LT(glm::length(p - foot->distance * foot->normal - foot->point), 1e-15);
  }
  EXPECT_GT(near, 1000);
}

TEST(FootPoint, HasTheSurfacesCurvatures) {
  // At the end of a semi-axis a the curvatures are a / b^2 and a / c^2.
  const Vec3 radii(9e-3, 6e-3, 7e-3);
  const FieldPtr field = implicitEllipsoid(kCenter, radii);
  for (int axis = 0; axis < 3; ++axis) {
    const double b = radii[(axis + 1) % 3];
    const double c = radii[(axis + 2) % 3];
    Vec3 p = kCenter;
    p[axis] += radii[axis] + 1e-3;
    const auto foot = footPoint(*field, p);
    ASSERT_TRUE(foot);
    const double first = radii[axis] / (b * b);
    const double second = radii[axis] / (c * c);
    EXPECT_NEAR(foot->curvature_sum, first + second, 1e-9 * (first + second)) << axis;
    EXPECT_NEAR(foot->curvature_product, first * second, 1e-9 * first * second) << axis;
    EXPECT_NEAR(foot->distance, 1e-3, 1e-15) << axis;
  }
}

TEST(FootPoint, HasAnEllipsoidsCurvaturesAnywhere) {
  // With S = x^2 / a^4 + y^2 / b^4 + z^2 / c^4 and P = a b c, the principal curvatures have the sum
  // (a^2 + b^2 + c^2 - |x|^2) / (P^2 S^1.5) and the product 1 / (P S)^2.
  const Vec3 radii(9e-3, 6e-3, 7e-3);
  const FieldPtr field = implicitEllipsoid(kCenter, radii);
  const Vec3 squares = radii * radii;
  const double volume = radii.x * radii.y * radii.z;
  Random random(12);
  for (int i = 0; i < 200; ++i) {
    const Vec3 x = radii * random.direction();
    const Vec3 slope = x / squares;
    const double s = glm::dot(slope, slope);
    const auto foot = footPoint(*field, kCenter + x + 1e-3 * slope / std::sqrt(s));
    ASSERT_TRUE(foot);
    ASSERT_LT(glm::length(foot->point - kCenter - x), 1e-14);
    const double sum =
        (squares.x + squares.y + squares.z - glm::dot(x, x)) / (volume * volume * s * std::sqrt(s));
    const double product = 1.0 / (volume * s * volume * s);
    ASSERT_NEAR(foot->curvature_sum, sum, 1e-8 * sum);
    ASSERT_NEAR(foot->curvature_product, product, 1e-8 * product);
  }
}

/// A plane whose values rise slowly, and a ball: from a point between them the plane looks nearer
/// than it is.
class SlowPlaneAndBall final : public Field {
 public:
  SlowPlaneAndBall(const Vec3& normal, FieldPtr ball) : normal_(normal), ball_(std::move(ball)) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample plane{0.2 * glm::dot(normal_, p), 0.2 * normal_};
    const FieldSample ball = ball_ ? ball_->sample(p) : plane;
    return ball.value < plane.value ? ball : plane;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return Box3::everything(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kBound; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return 1e-3; }

 private:
  Vec3 normal_;
  FieldPtr ball_;
};

TEST(FootPoint, ANearerPartIsSeenInEachDirectionOfACube) {
  constexpr double kAway = 1e-3;
  for (int n = 0; n < 27; ++n) {
    const Vec3 way(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    const double steps = glm::dot(way, way);
    if (steps != 1.0 && steps != 3.0) continue;  // neither a face's middle nor a corner
    const Vec3 out = way / std::sqrt(steps);
    const Vec3 p = kAway * out;
    const FieldPtr ball = sphere(2.1 * kAway * out, 0.6 * kAway);  // 0.5 mm from p
    EXPECT_TRUE(footPoint(SlowPlaneAndBall(out, nullptr), p)) << n;
    EXPECT_FALSE(footPoint(SlowPlaneAndBall(out, ball), p)) << n;
  }
}

TEST(FootPoint, OnAGyroidNoPointOfTheSurfaceIsNearer) {
  const FieldPtr field = gyroid(Vec3(0.0), 0.04);
  Random random(3);
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random.in({Vec3(-0.02), Vec3(0.02)});
    const auto foot = footPoint(*field, p);
    if (!foot) continue;
    ++found;
    EXPECT_EQ(foot->distance < 0.0, field->value(p) < 0.0);
    EXPECT_LT(std::fabs(field->value(foot->point)), 1e-14);
    // The sphere that reaches almost to the foot is entirely on p's side of the surface.
    for (int k = 0; k < 100; ++k) {
      const Vec3 at = p + 0.98 * foot->distance * random.direction();
      EXPECT_EQ(field->value(at) < 0.0, field->value(p) < 0.0);
    }
  }
  EXPECT_GT(found, 150);
}

TEST(FootPoint, WhereTheNearestPointIsNotFoundThereIsNone) {
  const Vec3 radii(10e-3, 10e-3, 4e-3);
  const FieldPtr flat = implicitEllipsoid(kCenter, radii);
  const FieldPtr exact = ellipsoid(kCenter, radii);
  int known = 0, unknown = 0;
  for (double x = -12e-3; x < 12e-3; x += 0.7e-3) {
    for (double z = -6e-3; z < 6e-3; z += 0.7e-3) {
      const Vec3 p = kCenter + Vec3(x, 0.1e-3, z);
      const auto foot = footPoint(*flat, p);
      foot ? ++known : ++unknown;
      if (foot) {
        EXPECT_NEAR(foot->distance, exact->value(p), 1e-12);
      }
    }
  }
  // Deep inside, between the two flat sides, Newton's method may find either side or none.
  EXPECT_GT(known, 2 * unknown);
  // The middle, where the gradient vanishes, and points that are NaN.
  EXPECT_FALSE(footPoint(*flat, kCenter));
  EXPECT_FALSE(footPoint(*flat, Vec3(std::numeric_limits<double>::quiet_NaN())));
}

TEST(FootPoint, OfAPointOnTheSurfaceIsThatPoint) {
  const FieldPtr field = implicitEllipsoid(kCenter, Vec3(9e-3, 6e-3, 7e-3));
  const Vec3 p = kCenter + Vec3(0.0, 6e-3, 0.0);
  const auto foot = footPoint(*field, p);
  ASSERT_TRUE(foot);
  EXPECT_LT(std::fabs(foot->distance), 1e-17);
  EXPECT_LT(glm::length(foot->normal - Vec3(0.0, 1.0, 0.0)), 1e-12);
}

}  // namespace
}  // namespace palpate::test
