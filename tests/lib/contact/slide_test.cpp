// How a proxy at rest follows the hand, against differences of closed forms: outside and inside a
// ball, on a cylinder and on a circular crease.

#include "palpate/contact/slide.h"

#include <gtest/gtest.h>

#include <functional>

#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

constexpr double kR = 0.04;

HeldWall heldAt(const FieldPtr& field, double side, const Vec3& x, double multiplier) {
  HeldWall wall;
  wall.field = field.get();
  wall.side = side;
  wall.jet = field->jet(x);
  wall.normal = side * glm::normalize(wall.jet.gradient);
  wall.multiplier = multiplier;
  return wall;
}

/// The gradient at `hand` of g . proxy(hand), by central differences.
Vec3 differences(const std::function<Vec3(const Vec3&)>& proxy, const Vec3& hand, const Vec3& g) {
  constexpr double kStep = 1e-6;
  Vec3 out(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 by(0.0);
    by[axis] = kStep;
    out[axis] = glm::dot(g, proxy(hand + by) - proxy(hand - by)) / (2.0 * kStep);
  }
  return out;
}

// Errors of central differences of a smooth map at this size: about (step / R)^2, and 1e-16 R /
// step.
constexpr double kTolerance = 1e-8;

TEST(GradientByHand, OnABallAndWithinIt) {
  const FieldPtr ball = sphere(Vec3(0.0), kR);
  const auto proxy = [](const Vec3& hand) { return kR * glm::normalize(hand); };
  Random random(11);
  for (const double side : {1.0, -1.0}) {
    for (const double depth : {1e-5, 1e-3, 0.5 * kR, 0.9 * kR}) {
      const Vec3 u = glm::normalize(random.in({Vec3(-1.0), Vec3(1.0)}));
      const Vec3 hand = (kR - side * depth) * u;
      const HeldWall wall = heldAt(ball, side, kR * u, depth);
      const Vec3 g = random.in({Vec3(-1.0), Vec3(1.0)});
      const Vec3 expected = differences(proxy, hand, g);
      EXPECT_LT(glm::length(gradientByHand(g, {&wall, 1}) - expected),
                kTolerance * (1.0 + glm::length(expected)) * kR / (kR - side * depth))
          << side << " " << depth;
    }
  }
}

TEST(GradientByHand, OnACylinderItBendsOneWayOnly) {
  const FieldPtr bar = cylinder(Vec3(0.0), Vec3(0, 0, 1), kR, 1.0);
  const auto proxy = [](const Vec3& hand) {
    const double rho = std::hypot(hand.x, hand.y);
    return Vec3(hand.x * kR / rho, hand.y * kR / rho, hand.z);
  };
  const HeldWall wall = heldAt(bar, 1.0, Vec3(kR, 0, 0.01), 0.4 * kR);
  const Vec3 g(0.3, -0.7, 0.5);
  const Vec3 expected = differences(proxy, Vec3(0.6 * kR, 0, 0.01), g);
  EXPECT_LT(glm::length(gradientByHand(g, {&wall, 1}) - expected), kTolerance);
}

TEST(GradientByHand, OnACircularCreaseAlongItOnly) {
  // A ball and a plane through z = 0.5 R; the hand is beyond both.
  const FieldPtr ball = sphere(Vec3(0.0), kR);
  const FieldPtr flat = halfSpace(Vec3(0, 0, 0.5 * kR), Vec3(0, 0, 1));
  const double rho = std::sqrt(0.75) * kR;
  const Vec3 x(rho, 0, 0.5 * kR);
  const Vec3 hand(0.7 * rho, 0, 0.45 * kR);
  // hand - x = -(m_ball * n_ball + m_flat * n_flat)
  const Vec3 n = x / kR;
  const double m_ball = -(hand - x).x / n.x;
  const double m_flat = -(hand - x).z - m_ball * n.z;
  ASSERT_GT(m_flat, -kR);
  const std::array<HeldWall, 2> walls = {heldAt(ball, 1.0, x, m_ball),
                                         heldAt(flat, 1.0, x, m_flat)};
  const auto proxy = [&](const Vec3& p) {
    const double length = std::hypot(p.x, p.y);
    return Vec3(p.x * rho / length, p.y * rho / length, 0.5 * kR);
  };
  const Vec3 g(0.2, 0.9, -0.4);
  EXPECT_LT(glm::length(gradientByHand(g, walls) - differences(proxy, hand, g)), kTolerance);
}

TEST(GradientByHand, IsNoneInACornerAndHeldNearAFocalPoint) {
  const std::array<FieldPtr, 3> faces = {halfSpace(Vec3(0.0), Vec3(1, 0, 0)),
                                         halfSpace(Vec3(0.0), Vec3(0, 1, 0)),
                                         halfSpace(Vec3(0.0), Vec3(0, 0, 1))};
  std::array<HeldWall, 3> corner;
  for (std::size_t i = 0; i < 3; ++i) corner[i] = heldAt(faces[i], 1.0, Vec3(0.0), 1e-3);
  EXPECT_EQ(gradientByHand(Vec3(1, 2, 3), corner), Vec3(0.0));
  const HeldWall focal = heldAt(sphere(Vec3(0.0), kR), 1.0, Vec3(kR, 0, 0), kR);
  EXPECT_NEAR(glm::length(gradientByHand(Vec3(0, 1, 0), {&focal, 1})), 1000.0, 1e-6);
}

TEST(GradientByHand, BeyondAFocalPointEigenvaluesCountByTheirMagnitude) {
  // |M| = sqrt(M M), and the square root of a 2 x 2 matrix has a closed form that needs no
  // eigenvectors.
  Random random(12);
  const FieldPtr any = sphere(Vec3(0.0), kR);
  for (int i = 0; i < 400; ++i) {
    HeldWall wall = heldAt(any, i % 2 == 0 ? 1.0 : -1.0, kR * random.direction(), 1.0);
    const Vec3 n = wall.normal;
    const Vec3 d = glm::normalize(glm::cross(n, random.direction()));
    const Vec3 e = glm::cross(n, d);
    // M = 1 - multiplier * side * Hessian / slope, in the frame (d, e), with eigenvalues of both
    // signs.
    const double m11 = random.uniform(-2.0, 2.0);
    const double m12 = random.uniform(-2.0, 2.0);
    const double m22 = random.uniform(-2.0, 2.0);
    const double det = m11 * m22 - m12 * m12;
    if (std::fabs(det) < 0.05) continue;
    const Mat3 m = m11 * glm::outerProduct(d, d) + m22 * glm::outerProduct(e, e) +
                   m12 * (glm::outerProduct(d, e) + glm::outerProduct(e, d));
    wall.jet.hessian = (Mat3(1.0) - m) * (glm::length(wall.jet.gradient) / wall.side);
    const double s11 = m11 * m11 + m12 * m12;
    const double s12 = m12 * (m11 + m22);
    const double s22 = m12 * m12 + m22 * m22;
    const double root = std::fabs(det);
    const double scale = std::sqrt(s11 + s22 + 2.0 * root);
    const double a11 = (s11 + root) / scale;
    const double a12 = s12 / scale;
    const double a22 = (s22 + root) / scale;
    const Vec3 g = random.direction();
    const double p = glm::dot(g, d);
    const double q = glm::dot(g, e);
    const Vec3 expected = ((a22 * p - a12 * q) / root) * d + ((a11 * q - a12 * p) / root) * e;
    // The smallest eigenvalue is about 0.05 / 3, so a rounding of 1e-16 is amplified by a hundred,
    // squared.
    EXPECT_LT(glm::length(gradientByHand(g, {&wall, 1}) - expected), 1e-11) << i;
  }
}

TEST(TangentialPart, IsWhatAllWallsLeave) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    std::array<HeldWall, 2> walls;
    for (HeldWall& wall : walls) wall.normal = glm::normalize(random.in({Vec3(-1.0), Vec3(1.0)}));
    const Vec3 v = random.in({Vec3(-1.0), Vec3(1.0)});
    EXPECT_EQ(tangentialPart(v, {}), v);
    const Vec3 one = tangentialPart(v, {walls.data(), 1});
    EXPECT_NEAR(glm::dot(one, walls[0].normal), 0.0, 1e-14);
    EXPECT_LE(glm::length(one), glm::length(v) * (1.0 + 1e-14));
    const Vec3 both = tangentialPart(v, walls);
    EXPECT_NEAR(glm::dot(both, walls[0].normal), 0.0, 1e-13);
    EXPECT_NEAR(glm::dot(both, walls[1].normal), 0.0, 1e-13);
    // The difference lies in the plane of both normals.
    EXPECT_NEAR(glm::dot(v - both, glm::cross(walls[0].normal, walls[1].normal)), 0.0, 1e-13);
  }
}

}  // namespace
}  // namespace palpate::test
