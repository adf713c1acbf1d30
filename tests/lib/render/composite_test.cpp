// Layers beneath a wall, felt through it: the stack along the inward normal, and its energy.

#include <cmath>
#include <numbers>

#include "lib/render/drive.h"
#include "palpate/contact/layered.h"
#include "support/alloc_guard.h"
#include "support/error_of.h"

namespace palpate::test {
namespace {

constexpr double kDepth = 1e-3;  // [m] pressed

std::string lumpText(const std::string& layers, const std::string& composite) {
  return R"(
palpate: 1
length: mm
materials:
  skin: {stiffness: 400 N/m, )" +
         composite + R"(}
  knot: {stiffness: 4000 N/m}
  table: {stiffness: 8000 N/m}
)" + layers;
}

const char* const kSlabs = R"(layers:
  - {name: tissue, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}
  - {name: plate, inside: {box: {center: [0, 0, -13], size: [400, 400, 10]}}, wall: knot}
  - {name: ground, inside: {half_space: {point: [0, 0, -40], normal: [0, 0, 1]}}, wall: table}
)";
const char* const kOn = "composite: {radius: 5, depth: 120}";

TEST(Composite, FeelsTheStackAlongItsNormal) {
  const std::array<StackLayer, 4> over = {
      StackLayer{400.0, 8e-3}, {4000.0, 10e-3}, {400.0, 22e-3}, {8000.0, 0.0}};
  Drive hand(sceneOf(lumpText(kSlabs, kOn)));
  (void)hand.to({0.02, 0.01, 0.005});
  const TickResult out = hand.walk({0.02, 0.01, -kDepth});
  const double expected = stackStiffness(over, 5e-3).stiffness * kDepth;
  EXPECT_TRUE(isNear(out.force, {0, 0, expected}, 1e-6 * expected));
  EXPECT_EQ(hand.region(), "outside") << "nothing was opened";
}

TEST(Composite, IsOffUnlessAsked) {
  Drive hand(sceneOf(lumpText(kSlabs, "")));
  (void)hand.to({0.02, 0.01, 0.005});
  EXPECT_TRUE(isNear(hand.walk({0.02, 0.01, -kDepth}).force, {0, 0, 0.4}, 1e-9));
}

TEST(Composite, LooksNoFurtherThanItsDepthAndFadesBefore) {
  double last = 1e9;
  // The plate's top is 8 mm down: a composite of 8 mm depth feels nothing of it, and a deeper one
  // feels it without a step.
  for (double depth = 60.0; depth > 7.5; depth -= 0.05) {
    const std::string layers = R"(layers:
  - {name: tissue, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}
  - {name: plate, inside: {half_space: {point: [0, 0, -8], normal: [0, 0, 1]}}, wall: knot}
)";
    Drive hand(
        sceneOf(lumpText(layers, "composite: {radius: 5, depth: " + std::to_string(depth) + "}")));
    (void)hand.to({0, 0, 0.001});
    const double force = hand.to({0, 0, -kDepth}).force.z;
    ASSERT_TRUE(last > 1e8 || std::fabs(force - last) < 0.04) << depth;
    last = force;
  }
  EXPECT_NEAR(last, 0.4, 1e-9);
}

TEST(Composite, OpensByTheForceThatIsFelt) {
  const std::string port = "ports: [{name: cut, between: [outside, tissue], opens_at: 0.6 N}]\n";
  Drive hand(sceneOf(lumpText(kSlabs, kOn) + port));
  (void)hand.to({0, 0, 0.001});
  double most = 0.0;
  for (int i = 0; i < 3000 && hand.region() == "outside"; ++i) {
    most = std::max(most, hand.last().force.z);
    (void)hand.to({0, 0, -1e-6 * i});
  }
  EXPECT_EQ(hand.region(), "tissue");
  EXPECT_NEAR(most, 0.6, 2e-3);
}

struct Loop {
  double felt = 0.0;  ///< [J] work on the hand
  double plain =
      0.0;  ///< [J] without the term for varying stiffness: from the force's part along the normal
  double stored = 0.0;  ///< [J]
};

/// Moves the hand around over the lump's middle and its rim, at varying depth. The wall is a ball
/// of `radius` [m], or a plane if that is 0.
Loop goRound(const ScenePtr& scene, double radius, int ticks) {
  Drive hand(scene);
  Loop loop;
  Vec3 last_hip(0.0);
  Vec3 last_force(0.0);
  Vec3 last_plain(0.0);
  for (int i = 0; i <= ticks; ++i) {
    const double a = 2.0 * std::numbers::pi * i / ticks;
    const double height = -0.6e-3 + 1.2e-3 * std::cos(a);
    Vec3 hip(4e-3 + 8e-3 * std::cos(2.0 * a), 7e-3 * std::sin(a), height);
    if (radius > 0.0) {
      const Vec3 middle(0, 0, -radius);
      hip = middle + (radius + height) * glm::normalize(Vec3(hip.x, hip.y, 0.0) - middle);
    }
    const TickResult out = hand.to(hip);
    const Vec3 gap = out.proxy - hip;
    const double length = glm::length(gap);
    const Vec3 n = length > 0.0 ? gap / length : Vec3(0.0);
    const Vec3 plain = glm::dot(out.force, n) * n;
    if (i > 0) {
      loop.felt += 0.5 * glm::dot(out.force + last_force, hip - last_hip);
      loop.plain += 0.5 * glm::dot(plain + last_plain, hip - last_hip);
    }
    loop.stored = std::max(loop.stored, 0.5 * glm::dot(plain, gap));
    last_hip = hip;
    last_force = out.force;
    last_plain = plain;
  }
  return loop;
}

TEST(Composite, AClosedWayOverTheLumpCostsAndGivesNothing) {
  const std::string plane = R"(layers:
  - {name: tissue, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}
  - {name: lump, inside: {ellipsoid: {center: [1, 2, -12], radii: [30, 25, 4]}}, wall: knot}
  - {name: ground, inside: {half_space: {point: [0, 0, -40], normal: [0.2, 0, 1]}}, wall: table}
)";
  const std::string ball = R"(layers:
  - {name: tissue, inside: {sphere: {center: [0, 0, -60], radius: 60}}, wall: skin}
  - {name: lump, inside: {ellipsoid: {center: [1, 2, -12], radii: [30, 25, 4]}}, wall: knot}
)";
  for (const bool is_ball : {false, true}) {
    const Loop loop =
        goRound(sceneOf(lumpText(is_ball ? ball : plane, kOn)), is_ball ? 0.06 : 0.0, 20000);
    EXPECT_GT(std::fabs(loop.plain), 1e-3 * loop.stored) << "what there is to be made up for";
    // The remainder comes from the differences by which the derivatives of the stack are computed.
    EXPECT_LT(std::fabs(loop.felt), 0.01 * std::fabs(loop.plain)) << is_ball;
  }
}

TEST(Composite, AcrossTheRimOfALumpLittleIsLeft) {
  // At the rim of a ball the ray grazes the ball, and the depths of the interfaces along the ray
  // have no slope there: that part of the force is missing. This test limits the work that results.
  const std::string layers = R"(layers:
  - {name: tissue, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}
  - {name: lump, inside: {sphere: {center: [0, 0, -13], radius: 5}}, wall: knot}
  - {name: ground, inside: {half_space: {point: [0, 0, -40], normal: [0, 0, 1]}}, wall: table}
)";
  const Loop loop = goRound(sceneOf(lumpText(layers, kOn)), 0.0, 20000);
  EXPECT_LT(std::fabs(loop.felt), 0.02 * loop.stored);
}

TEST(Composite, TheRimOfALumpIsNoEdge) {
  Drive hand(sceneOf(lumpText(R"(layers:
  - {name: tissue, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}
  - {name: lump, inside: {sphere: {center: [0, 0, -13], radius: 5}}, wall: knot}
  - {name: ground, inside: {half_space: {point: [0, 0, -40], normal: [0, 0, 1]}}, wall: table}
)",
                              kOn)));
  (void)hand.to({-0.012, 0.001, 0.001});
  Vec3 last = hand.to({-0.012, 0.001, -kDepth}).force;
  double sideways = 0.0;
  double step = 0.0;
  for (int i = 0; i <= 2400; ++i) {
    const Vec3 force = hand.to({-0.012 + 1e-5 * i, 0.001, -kDepth}).force;
    sideways = std::max(sideways, std::hypot(force.x, force.y));
    step = std::max(step, glm::length(force - last));
    last = force;
  }
  // The stiffness rises by 270 N/m over 5 mm, at most by 2e5 N/m^2, times half the square of the
  // depth. With a sharp rim there would be no bound.
  EXPECT_LT(sideways, 0.1);
  // Over a way of 10 um the force changes by less than can be felt (0.04 N).
  EXPECT_LT(step, 0.02);
}

TEST(Composite, TheTickAllocatesNothing) {
  Drive hand(sceneNamed("lump"));
  (void)hand.to({0, 0, 0.001});
  const testing::AllocGuard guard;
  for (int i = 0; i < 500; ++i) {
    (void)hand.renderer().update({{0.02 * std::sin(0.05 * i), 0.003, -1e-3}, Vec3(0.0)});
  }
  EXPECT_EQ(guard.violations(), 0);
}

TEST(Composite, RefusesARadiusWithoutADepth) {
  SceneDescription description = parseScene(lumpText(kSlabs, kOn), "test.yaml");
  description.materials[0].composite.depth = 0.0;
  EXPECT_EQ(errorOf([&] { (void)compile(description); }).problem().code, "scene.parameter");
}

}  // namespace
}  // namespace palpate::test
