// Two walls of different kinds at a right angle: each pushes by its own law, as if the other were not there.

#include <gtest/gtest.h>

#include <cmath>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

/// A floor below z = 0 and a wall left of x = 0; the hand is in the corner that they leave.
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
    // The proxy counts as on a wall within a billionth of its size.
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

}  // namespace
}  // namespace palpate::test
