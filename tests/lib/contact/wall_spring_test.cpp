// A wall's spring against its formula, its slope and its energy.

#include "palpate/contact/wall_spring.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::test {
namespace {

// The work needed to press `depth` deep, by Simpson's rule.
double workTo(const WallSpring& spring, double depth) {
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight * spring.force(depth * i / kSteps);
  }
  return sum * depth / (3.0 * kSteps);
}

TEST(WallSpring, StraightIsStraightToTheLastBit) {
  const WallSpring spring{.stiffness = 1234.5};
  for (const double depth : {1e-9, 1e-3, 0.1}) {
    EXPECT_EQ(spring.secant(depth), 1234.5);
    EXPECT_EQ(spring.force(depth), 1234.5 * depth);
  }
  EXPECT_EQ(spring.force(0.0), 0.0);
  EXPECT_EQ(spring.force(-1e-3), 0.0);
}

TEST(WallSpring, FollowsItsFormula) {
  const WallSpring okamura{.stiffness = 40.0, .stiffening = 2e4};
  EXPECT_NEAR(okamura.force(5e-3), 40.0 * 5e-3 + 2e4 * 25e-6, 1e-15);
  // Hertz: a ball of radius r on a half-space of E*: F = 4/3 E* sqrt(r) d^1.5.
  const double e_star = 60e3 / (1.0 - 0.45 * 0.45);
  const double c = 4.0 / 3.0 * e_star * std::sqrt(2e-3);
  const double reference = 1e-3;
  const WallSpring hertz{
      .stiffness = c * std::sqrt(reference), .exponent = 1.5, .reference = reference};
  for (const double depth : {1e-5, 1e-3, 7e-3}) {
    EXPECT_NEAR(hertz.force(depth), c * std::pow(depth, 1.5), 1e-13);
  }
  const WallSpring cubic{.stiffness = 300.0, .exponent = 3.0, .reference = 2e-3};
  EXPECT_NEAR(cubic.force(4e-3), 300.0 * 2e-3 * 8.0, 1e-12);
}

TEST(WallSpring, EnergyIsTheWorkDone) {
  for (const WallSpring& spring :
       {WallSpring{.stiffness = 700.0}, WallSpring{.stiffness = 700.0, .stiffening = 3e4},
        WallSpring{.stiffness = 700.0, .stiffening = 1e4, .exponent = 1.5, .reference = 1e-3},
        WallSpring{.stiffness = 700.0, .exponent = 2.5, .reference = 3e-3}}) {
    const double depth = 4e-3;
    const double energy = spring.stiffness * spring.energyPerStiffness(depth) +
                          spring.stiffening * WallSpring::energyPerStiffening(depth);
    // Simpson's error, because the force begins like d^1.5, is about 1e-9 of the whole.
    EXPECT_NEAR(energy, workTo(spring, depth), 1e-8 * energy);
  }
}

}  // namespace
}  // namespace palpate::test
