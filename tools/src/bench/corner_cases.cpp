#include <array>
#include <cmath>
#include <numbers>

#include "bench/contact_case.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate::tools {
namespace {

using oracle::Held;
using oracle::Minima;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kStroke = 0.2;      // [m/s]
constexpr std::size_t kStride = 16;  // ticks between two that the oracle judges

/// A curve that moves to all sides of `about`, never the same way twice, at most `reach` [m] off
/// along each axis.
Curve wander(const Vec3& about, double reach) {
  return [=](double s) {
    return about + reach * Vec3(std::sin(s), std::sin(1.31 * s + 0.4), std::sin(1.73 * s + 0.9));
  };
}

struct Ball {
  Vec3 center;
  double radius;
};
const std::array<Ball, 3> kBalls = {
    {{Vec3(0.0), 0.020}, {Vec3(0.020, 0.0, 0.0), 0.015}, {Vec3(0.010, 0.018, 0.0), 0.012}}};

/// The common point of the three spheres above the xy plane: differences of the sphere equations
/// are planes.
Vec3 ballsCorner() {
  const auto power = [](const Ball& ball) {
    return glm::dot(ball.center, ball.center) - ball.radius * ball.radius;
  };
  const double x = (power(kBalls[1]) - power(kBalls[0])) / (2.0 * kBalls[1].center.x);
  const double y = (power(kBalls[2]) - power(kBalls[0]) - 2.0 * kBalls[2].center.x * x) /
                   (2.0 * kBalls[2].center.y);
  return {x, y, std::sqrt(kBalls[0].radius * kBalls[0].radius - x * x - y * y)};
}

}  // namespace

ContactCase boxCorner() {
  const Vec3 half(0.03, 0.02, 0.01);
  return along(solidScene(box(Vec3(0.0), 2.0 * half), StartIn::kSolid), Vec3(0.0),
               wander(half, 0.004), 0.0, 40.0 * kTurn, kStroke, judgeByFormula([=](const Vec3& p) {
                 return oracle::boxMinima(p, -half, half, Held::kInside);
               }));
}

ContactCase threeBalls(bool hollow) {
  std::vector<FieldPtr> balls;
  balls.reserve(kBalls.size());
  for (const Ball& ball : kBalls) balls.push_back(sphere(ball.center, ball.radius));
  const FieldPtr solid = hollow ? intersect(balls) : subtract(balls);
  const Vec3 corner = ballsCorner();
  // The path starts in free space: straight above the two balls that are cut out, or in the middle
  // of all three.
  const Vec3 free = hollow ? Vec3(0.010, 0.008, 0.0) : Vec3(-0.010, -0.005, 0.005);
  return along(solidScene(solid, StartIn::kSolid), free, wander(corner, 0.004), 0.0, 20.0 * kTurn,
               kStroke, judgeByOracle(oracle::FeasibleSet::inside(solid), kStride));
}

ContactCase coneTip(double half_angle) {
  const double height = 0.03;
  const double radius = height * std::tan(half_angle);
  const Vec3 up(0.0, 0.0, 1.0);
  return along(solidScene(cone(Vec3(0.0), up, radius, height), StartIn::kSolid), 0.5 * height * up,
               wander(height * up, 0.003), 0.0, 40.0 * kTurn, kStroke,
               judgeByFormula([=](const Vec3& p) {
                 return oracle::coneInside(p, Vec3(0.0), up, radius, height);
               }));
}

ContactCase nestedCsg() {
  const auto mm = [](double x, double y, double z) { return 1e-3 * Vec3(x, y, z); };
  const Vec3 up(0.0, 0.0, 1.0);
  const FieldPtr dome = intersect({sphere(Vec3(0.0), 0.034), halfSpace(mm(0, 0, 18), up)});
  const FieldPtr bar =
      subtract({capsule(mm(-40, 10, 0), mm(40, 10, 0), 0.005), sphere(mm(4, 10, 4), 0.007)});
  const FieldPtr columns = unite({capsule(mm(-14, -6, -40), mm(-14, -6, 40), 0.004), bar});
  const FieldPtr stone = subtract({sphere(mm(12, -10, -6), 0.009), sphere(mm(12, -14, 0), 0.006)});
  const FieldPtr spike = cone(mm(0, -4, -22), up, 0.008, 0.026);
  // Only a few parts have faces: the oracle tries every three of them in every branch of the tree.
  const FieldPtr tree = subtract({dome, unite({columns, stone}), spike});
  const auto curve = [](double s) {
    return 1e-3 * Vec3(30.0 * std::sin(s), 25.0 * std::sin(1.31 * s + 0.4),
                       20.0 * std::sin(1.73 * s + 0.9));
  };
  return along(solidScene(tree, StartIn::kSolid), mm(0, -4, 12), curve, 0.0, 6.0 * kTurn, kStroke,
               judgeByOracle(oracle::FeasibleSet::inside(tree), 4 * kStride));
}

}  // namespace palpate::tools
