// A wall whose stiffness differs from place to place gives back the energy that it was given, and
// no more.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lib/render/drive.h"
#include "palpate/contact/slide.h"
#include "palpate/fields/primitives.h"
#include "support/test_maps.h"

namespace palpate::test {
namespace {

using testing::FunctionMap;

/// 600 N/m, varying by 300 N/m over some centimeters along all axes.
MaterialMapPtr hills() {
  return std::make_shared<FunctionMap>(
      [](const Vec3& p) {
        const Vec3 k(150.0, 170.0, 190.0);  // [1/m]
        const Vec3 phase = k * p + Vec3(0.3, 1.1, 0.7);
        MaterialMap::Sample out{600.0, Vec3(0.0)};
        for (int i = 0; i < 3; ++i) {
          out.value += 100.0 * std::sin(phase[i]);
          out.gradient[i] = 100.0 * k[i] * std::cos(phase[i]);
        }
        return out;
      },
      MaterialMap::Range{300.0, 900.0});
}

struct Shape {
  std::string name;
  std::vector<FieldPtr> layers;
  std::string start;
  std::function<Vec3(double)> path;  ///< closed: [0, 1] -> [m], in the air at both ends
};

ScenePtr sceneOf(const Shape& shape, const Parameter& stiffness, const Friction& friction) {
  SceneDescription description;
  Material wall;
  wall.name = "wall";
  wall.stiffness = stiffness;
  wall.friction = friction;
  description.materials = {wall};
  for (const FieldPtr& field : shape.layers) {
    LayerDescription layer;
    layer.name = "body" + std::to_string(description.layers.size());
    layer.inside = std::make_shared<FieldSource>(field);
    layer.wall.material = "wall";
    description.layers.push_back(layer);
  }
  description.start_region = shape.start;
  return compile(description);
}

struct Loop {
  double corrected = 0.0;  ///< [J] work of the actual force on the hand over the closed path
  double plain = 0.0;      ///< [J] the same for the spring alone, stiffness * (proxy - hip)
  double stored = 0.0;     ///< [J] largest energy of the spring on the way
};

/// Work by the trapezoidal rule: its error falls with the square of the step.
Loop goRound(const Shape& shape, const MaterialMapPtr& map, const Friction& friction, int ticks) {
  Drive hand(sceneOf(shape, map, friction));
  Loop loop;
  Vec3 last_hip(0.0);
  Vec3 last_force(0.0);
  Vec3 last_spring(0.0);
  for (int i = 0; i <= ticks; ++i) {
    const Vec3 hip = shape.path(static_cast<double>(i) / ticks);
    const TickResult out = hand.to(hip);
    const Vec3 gap = out.proxy - hip;
    const Vec3 spring = map->value(out.proxy) * gap;
    if (i > 0) {
      loop.corrected += 0.5 * glm::dot(out.force + last_force, hip - last_hip);
      loop.plain += 0.5 * glm::dot(spring + last_spring, hip - last_hip);
    }
    loop.stored = std::max(loop.stored, 0.5 * map->value(out.proxy) * glm::dot(gap, gap));
    last_hip = hip;
    last_force = out.force;
    last_spring = spring;
  }
  return loop;
}

std::vector<Shape> shapes() {
  const double turn = 2.0 * std::numbers::pi;
  const FieldPtr ball = sphere(Vec3(0.0), 0.02);
  return {
      {"plane",
       {halfSpace(Vec3(0.0), Vec3(0, 0, 1))},
       "outside",
       [=](double t) {
         return Vec3(0.02 * std::cos(turn * t), 0.015 * std::sin(turn * t),
                     -1e-3 + 2e-3 * std::cos(turn * t));
       }},
      {"ball from outside",
       {ball},
       "outside",
       [=](double t) {
         const double a = 2.0 * turn * t;
         const double r = 0.018 + 0.003 * std::cos(turn * t);
         return r * Vec3(std::cos(a) * std::cos(0.4), std::sin(a) * std::cos(0.4), std::sin(0.4));
       }},
      {"ball from within",
       {ball},
       "body0",
       [=](double t) {
         const double a = turn * t;
         const double r = 0.022 - 0.003 * std::cos(turn * t);
         return r * Vec3(std::cos(a) * std::cos(0.4 * std::sin(a)),
                         std::sin(a) * std::cos(0.4 * std::sin(a)), std::sin(0.4 * std::sin(a)));
       }},
      {"groove",  // two walls of the same stiffness hold the proxy in their edge
       {halfSpace(Vec3(0.0), glm::normalize(Vec3(0.8, 0, 1))),
        halfSpace(Vec3(0.0), glm::normalize(Vec3(-0.9, 0, 1)))},
       "outside",
       [=](double t) {
         return Vec3(0.002 * std::cos(3.0 * turn * t), 0.02 * std::sin(turn * t),
                     -1e-3 + 3e-3 * std::cos(turn * t));
       }},
  };
}

TEST(VaryingStiffness, AClosedWayCostsAndGivesNothing) {
  const MaterialMapPtr map = hills();
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    const Loop coarse = goRound(shape, map, {}, 4000);
    const Loop fine = goRound(shape, map, {}, 16000);
    EXPECT_GT(fine.stored, 2e-4);
    // Without the gradient term the path gives or takes energy, and a finer trace does not change
    // that.
    EXPECT_GT(std::fabs(fine.plain), 0.02 * fine.stored);
    EXPECT_NEAR(coarse.plain, fine.plain, 0.02 * std::fabs(fine.plain));
    // With it, only the error of the sum over ticks is left: less than 1e-5 of the stored energy,
    // and 4 x 4 times less for steps 4 times shorter where the rule's error is the only one.
    EXPECT_LT(std::fabs(fine.corrected), 1e-5 * fine.stored);
    EXPECT_LT(std::fabs(fine.corrected), 1e-3 * std::fabs(fine.plain));
  }
}

TEST(VaryingStiffness, FrictionOnlyTakes) {
  const MaterialMapPtr map = hills();
  for (const Shape& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    const Loop with = goRound(shape, map, {0.05, 0.04}, 16000);
    EXPECT_LT(with.corrected, -1e-3 * with.stored);
  }
}

TEST(VaryingStiffness, StickingAndSlidingPassIntoEachOtherWithoutAStep) {
  // A plane, 2 mm deep: a gradient of 5e4 N/m per m pulls with 0.1 N. Drawn back and forth, the
  // proxy sticks at every turn and slides in between.
  const MaterialMapPtr map = testing::linearMap(1000.0, {5e4, 0, 0}, {100.0, 1900.0});
  Drive hand(sceneOf(shapes()[0], map, {0.1, 0.1}));
  (void)hand.to({0.0, 0.0, 0.001});
  Vec3 last = hand.walk({0.0, 0.0, -2e-3}).force;
  const double stride = 5e-6;  // [m]
  double worst = 0.0;
  int stuck = 0;
  int slid = 0;
  Vec3 proxy = hand.last().proxy;
  for (int i = 1; i <= 20000; ++i) {
    const double x = 3e-3 * std::sin(stride / 3e-3 * i);
    const TickResult out = hand.to({x, 0.0, -2e-3});
    worst = std::max(worst, glm::length(out.force - last));
    (out.proxy == proxy ? stuck : slid) += 1;
    last = out.force;
    proxy = out.proxy;
  }
  EXPECT_GT(stuck, 2000);
  EXPECT_GT(slid, 2000);
  // One stride on a spring of at most 1150 N/m, plus the height's part of it.
  EXPECT_LT(worst, 1.2 * 1150.0 * stride);
}

TEST(VaryingStiffness, WithFrictionTheLeanIsFeltThroughTheLag) {
  // Drawn up and down the gradient of the stiffness, the friction is that of the cone centered on
  // the frictionless rest: its mean over both directions is the force of a wall without friction.
  const double depth = 2e-3;
  const double slope = 2e4;
  const MaterialMapPtr map = testing::linearMap(1000.0, {slope, 0, 0}, {100.0, 1900.0});
  double sum = 0.0;
  for (const double way : {1.0, -1.0}) {
    Drive hand(sceneOf(shapes()[0], map, {0.1, 0.1}));
    (void)hand.to({-way * 2e-3, 0.0, 0.001});
    (void)hand.to({-way * 2e-3, 0.0, -depth});
    TickResult out;
    for (int i = 0; i <= 1000; ++i) out = hand.to({way * (-2e-3 + 2e-6 * i), 0.0, -depth});
    // The proxy lags behind the hand by 0.2 mm in both directions.
    sum += out.force.x;
    EXPECT_NEAR(std::fabs(out.force.x), 0.2, 0.05);
  }
  EXPECT_NEAR(0.5 * sum, -0.5 * depth * depth * slope, 2e-3);
}

TEST(VaryingStiffness, TheTermIsHalfTheSquareOfTheDepthTimesTheSlope) {
  // A plane, 2 mm deep, 2e4 N/m per m: 0.04 N towards the softer side.
  Shape plane = shapes()[0];
  Drive hand(sceneOf(plane, testing::linearMap(1000.0, {2e4, 0, 0}, {100.0, 1900.0}), {}));
  (void)hand.to({0.01, 0, 0.001});
  const TickResult out = hand.walk({0.01, 0, -2e-3});
  EXPECT_TRUE(isNear(out.force, {-0.04, 0.0, 2.4}, 1e-9));
}

TEST(VaryingStiffness, GradientByHandFollowsTheClosestPoint) {
  // The hand is at distance R - d from the middle of a ball of radius R (R + d when felt from
  // inside), its closest point is x. The gradient of v . x by the hand is the part of v along the
  // surface, times R / (R - d) or R / (R + d).
  const FieldPtr ball = sphere(Vec3(0.0), 0.02);
  const Vec3 x(0.02, 0, 0);
  const Vec3 v(3.0, 1.0, -2.0);
  for (const double side : {1.0, -1.0}) {
    HeldWall wall;
    wall.field = ball.get();
    wall.side = side;
    wall.jet = ball->jet(x);
    wall.normal = side * wall.jet.gradient;
    wall.multiplier = 0.004;
    const double factor = 0.02 / (0.02 - side * 0.004);
    EXPECT_TRUE(isNear(gradientByHand(v, std::span(&wall, 1)), factor * Vec3(0, 1, -2), 1e-12));
  }
}

}  // namespace
}  // namespace palpate::test
