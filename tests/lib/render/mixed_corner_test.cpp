// Two walls of different kinds at a right angle: each pushes by its own law, as if the other were
// not there.

#include <gtest/gtest.h>

#include <cmath>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

/// A floor below z = 0 and a wall left of x = 0; the hand is in the corner between them.
std::string cornerText(const std::string& floor, const std::string& wall) {
  return R"(
palpate: 1
length: mm
materials:
  floor: {)" +
         floor +
         R"(}
  wall: {)" +
         wall +
         R"(}
layers:
  - {name: ground, inside: {box: {center: [0, 0, -50], size: [400, 400, 100]}}, wall: floor}
  - {name: side, inside: {half_space: {point: [0, 0, 0], normal: [1, 0, 0]}}, wall: wall}
)";
}

Vec3 forceAt(const std::string& text, const Vec3& hip) {
  Drive hand(sceneOf(text));
  (void)hand.to(mm(5, 0, 5));
  (void)hand.walk(mm(1, 0, 1));
  return hand.walk(hip).force;
}

TEST(MixedCorner, AWallThatStiffensDoesSoAsDeepAsItIsPressed) {
  const std::string text =
      cornerText("stiffness: 500 N/m, curve: {stiffening: 2e5 N/m^2}", "stiffness: 400 N/m");
  for (const double depth : {0.5e-3, 2e-3, 5e-3}) {
    const Vec3 force = forceAt(text, Vec3(-1e-3, 0.0, -depth));
    const double expected = 500.0 * depth + 2e5 * depth * depth;
    // The proxy counts as on a wall within a billionth of the wall's feature size.
    EXPECT_NEAR(force.z, expected, 1e-6 * expected) << depth;
    EXPECT_NEAR(force.x, 0.4, 1e-6) << depth;
  }
}

TEST(MixedCorner, AHertzianWallDoesToo) {
  const std::string text = cornerText("stiffness: 800 N/m, curve: {exponent: 1.5, reference: 1 mm}",
                                      "stiffness: 3000 N/m");
  for (const double depth : {0.5e-3, 2e-3, 5e-3}) {
    const Vec3 force = forceAt(text, Vec3(-1e-3, 0.0, -depth));
    const double expected = 0.8 * std::pow(depth / 1e-3, 1.5);
    EXPECT_NEAR(force.z, expected, 1e-6 * expected) << depth;
    EXPECT_NEAR(force.x, 3.0, 1e-5) << depth;
  }
}

TEST(MixedCorner, EachOfThreeIsItselfWhereTheProxyCameAlongOneInATick) {
  // The hand goes from each of the walls to the corner of all three, in one tick.
  const std::string text = cornerText("stiffness: 3000 N/m", "stiffness: 500 N/m") +
                           "  - {name: back, inside: {half_space: {point: [0, 0, 0], normal: "
                           "[0, 1, 0]}}, wall: wall}\n";
  for (const Vec3& start : {mm(-1, 5, 5), mm(5, -1, 5), mm(5, 5, -1)}) {
    Drive hand(sceneOf(text));
    (void)hand.to(mm(5, 5, 5));
    (void)hand.walk(start);
    const TickResult out = hand.to(mm(-1, -1, -1));
    ASSERT_TRUE(out.settled);
    // The proxy counts as on a wall within a billionth of the wall's feature size.
    EXPECT_TRUE(isNear(out.force, Vec3(0.5, 0.5, 3.0), 1e-6));
  }
}

/// The probe starts inside a cone whose wall meets that of a cylinder in a shallow valley; `third`
/// is a further layer.
ScenePtr valley(const char* third) {
  return sceneOf(std::string(R"(
palpate: 1
length: mm
start: {region: cone}
materials:
  m_cone: {stiffness: 1100 N/m}
  m_third: {stiffness: 1900 N/m}
  m_cyl: {stiffness: 1500 N/m}
layers:
  - {name: cone, wall: m_cone, inside: {cone: {base: [-7.52, -3.76, -3.22], axis: [0.91, -0.02, -0.42], radius: 4.06, height: 6.14}}}
  - {name: third, wall: m_third, inside: )") +
                 third + R"(}
  - {name: cyl, wall: m_cyl, inside: {cylinder: {center: [6.28, -3.86, -0.45], axis: [-0.01, -0.49, 0.87], radius: 9.72, height: 40}}}
)");
}

// A lid 15 um behind the proxy leaves so little room that the scene's sampling finds no place where
// cone and cylinder meet. They must still be felt together, as if the lid were far away.
TEST(MixedCorner, WallsThatMeetInALittleGapAreFeltTogether) {
  const auto lid = makeRenderer(
      valley("{half_space: {point: [-2.989895, -4.624097, -4.937474], normal: [0.782617, "
             "-0.615225, 0.094917]}}"));
  const auto far = makeRenderer(valley("{sphere: {center: [100, 0, 0], radius: 5}}"));
  const Vec3 from(-0.0029848293947153993, -0.0046260122321973686, -0.0049369066530820438);
  const Vec3 to(-0.001805452761208366, -0.0060633425918614316, -0.0048050826722480068);
  TickResult with;
  TickResult without;
  constexpr int kSteps = 400;
  for (int i = 0; i <= kSteps; ++i) {
    const Vec3 hand = glm::mix(from, to, 1.0 * i / kSteps);
    with = lid->update({hand});
    without = far->update({hand});
    EXPECT_LT(glm::length(with.force - without.force), 1e-6) << "step " << i;
  }
  // The cone's law alone would give 2.04 N along its normal; with springs in series the force is
  // this.
  EXPECT_LT(glm::length(without.force - Vec3(-1.698, 1.367, -0.155)), 2e-3);
}

}  // namespace
}  // namespace palpate::test
