// The largest stiffness that a sampled loop can hold, against closed forms and published
// conditions.

#include "palpate/devices/stability.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "palpate/core/error.h"
#include "palpate/devices/device_presets.h"

namespace palpate::devices {
namespace {

LoopModel bare(double mass, double damping, double period, int delay = 0) {
  LoopModel loop;
  loop.device.mass = mass;
  loop.device.damping = damping;
  loop.period = period;
  loop.delay = delay;
  return loop;
}

TEST(Stability, WithoutDelayAndOwnDampingTheLimitIsTheClosedForm) {
  // A mass alone against a spring and a damper by backward difference: (2 B / T) (2 - B') / (2 +
  // B'), B' = B T / m.
  for (const double ratio : {0.001, 0.01, 0.1, 0.5, 0.828, 1.5, 1.99}) {
    for (const double mass : {0.045, 1.5}) {
      for (const double period : {1e-3, 1e-4}) {
        const double damping = ratio * mass / period;
        const double expected = 2.0 * damping / period * (2.0 - ratio) / (2.0 + ratio);
        // 1e-6: near 1, rounding moves a double root by its square root.
        EXPECT_NEAR(largestStiffness(bare(mass, 0.0, period), damping), expected, 1e-6 * expected)
            << ratio << " " << mass << " " << period;
      }
    }
  }
  EXPECT_EQ(largestStiffness(bare(0.1, 0.0, 1e-3), 2.01 * 0.1 / 1e-3), 0.0);
  EXPECT_EQ(largestStiffness(bare(0.1, 0.0, 1e-3), 0.0), 0.0);
}

TEST(Stability, WithoutDelayAndWallDampingTheLimitIsTheClosedForm) {
  // (1 - e) / (p r - e q), with the exact step of a mass in a viscous medium.
  for (const double ratio : {1e-5, 0.001, 0.01, 0.1, 0.5, 2.0}) {
    const double mass = 0.2;
    const double period = 1e-3;
    const double damping = ratio * mass / period;
    const double gone = -std::expm1(-ratio);  // 1 - e
    const double r = gone / damping;
    const double p = r * mass;
    const double q = (period - p) / damping;
    const double expected = gone / (p * r - (1.0 - gone) * q);
    EXPECT_NEAR(largestStiffness(bare(mass, damping, period)), expected, 2e-6 * expected) << ratio;
  }
}

struct Row {
  double ratio;
  std::array<double, 4> by_delay;  // K T^2 / m
};

TEST(Stability, WithDelayTheLimitDependsOnTheRatiosAlone) {
  // These values come from simulations and hold to the digits given.
  constexpr std::array kWall = {Row{0.01, {0.0198, 0.0066, 0.0039, 0.0028}},
                                Row{0.1, {0.1810, 0.0592, 0.0342, 0.0233}},
                                Row{0.5, {0.6000, 0.1397, 0.0185, 0.0}}};
  constexpr std::array kOwn = {Row{0.01, {0.02003, 0.00669, 0.00402, 0.00287}},
                               Row{0.1, {0.20339, 0.06846, 0.04164, 0.03015}},
                               Row{0.5, {1.0905, 0.3732, 0.2335, 0.1727}}};
  const double mass = 0.3;
  const double period = 2.5e-4;
  const double unit = mass / (period * period);
  for (int delay = 0; delay < 4; ++delay) {
    for (const Row& row : kWall) {
      const double k = largestStiffness(bare(mass, 0.0, period, delay), row.ratio * mass / period);
      EXPECT_NEAR(k / unit, row.by_delay[static_cast<std::size_t>(delay)], 6e-5)
          << row.ratio << " " << delay;
    }
    for (const Row& row : kOwn) {
      const double k = largestStiffness(bare(mass, row.ratio * mass / period, period, delay));
      EXPECT_NEAR(k / unit, row.by_delay[static_cast<std::size_t>(delay)],
                  row.ratio < 0.05 ? 6e-6 : 6e-5)
          << row.ratio << " " << delay;
    }
  }
}

TEST(Stability, TheLargestDragOfAMassAloneIsTheClosedForm) {
  // z^(d + 1) (z - 1) / (z + 1) = -B' / 2 on the unit circle: B' = 2 tan(pi / (4 (d + 1))).
  for (int delay = 0; delay < 4; ++delay) {
    const double expected = 2.0 * std::tan(std::numbers::pi / (4.0 * (delay + 1)));
    EXPECT_NEAR(largestDamping(bare(0.1, 0.0, 1e-3, delay)) * 1e-3 / 0.1, expected, 1e-6);
  }
}

TEST(Stability, PresetsHaveTheLimitsThatSimulationsFound) {
  struct Case {
    const char* name;
    std::array<double, 4> by_delay;  // [N/m] nobody holds it, 1 ms
    double held;                     // [N/m] held with a relaxed hand's grip, no delay
  };
  constexpr std::array kCases = {Case{"excalibur", {10006, 3336, 2003, 1431}, 25925},
                                 Case{"falcon", {1000, 334, 200, 143}, 9296},
                                 Case{"touch", {40, 13, 8, 6}, 6699},
                                 Case{"touch_x", {20, 7, 4, 3}, 6680},
                                 Case{"premium_1_0", {10, 3, 2, 1}, 7019},
                                 Case{"premium_1_5", {20, 7, 4, 3}, 7028},
                                 Case{"omega_3", {600, 200, 120, 86}, 8987},
                                 Case{"delta_3", {800, 267, 160, 114}, 9705},
                                 Case{"inverse3", {400, 133, 80, 57}, 8834}};
  ASSERT_EQ(devicePresets().size(), kCases.size());
  for (const Case& each : kCases) {
    LoopModel loop;
    loop.device = devicePreset(each.name).model();
    for (int delay = 0; delay < 4; ++delay) {
      loop.delay = delay;
      const double expected = each.by_delay[static_cast<std::size_t>(delay)];
      EXPECT_NEAR(largestStiffness(loop), expected, 0.51 + 1e-4 * expected) << each.name << delay;
    }
    loop.delay = 0;
    loop.period = 2.5e-4;
    // The limit is proportional to the rate to 0.1 %, except for the rounding of the numbers above.
    const double faster = 4.0 * each.by_delay[0];
    EXPECT_NEAR(largestStiffness(loop), faster, 2.1 + 1e-3 * faster) << each.name;
    loop.period = 1e-3;
    loop.hand = handPreset("relaxed");
    EXPECT_NEAR(largestStiffness(loop), each.held, 1.0) << each.name;
  }
}

TEST(Stability, AHandThatIsOneWithTheDeviceAddsItsMassAndDamping) {
  LoopModel loop;
  loop.device = devicePreset("excalibur").model();
  loop.hand = handPreset("relaxed");
  loop.hand->grip_stiffness = 0.0;
  loop.hand->grip_damping = 0.0;
  EXPECT_NEAR(largestStiffness(loop), 18017.0, 1.0);
  loop.device = devicePreset("touch").model();
  EXPECT_NEAR(largestStiffness(loop), 8078.0, 1.0);
}

TEST(Stability, ALagCountsAsDelay) {
  LoopModel loop = bare(0.2, 0.5, 1e-3);
  loop.device.lag = 5e-4;
  const double expected = 0.5 / (0.5e-3 + 5e-4);
  EXPECT_NEAR(largestStiffness(loop), expected, 0.01 * expected);
}

TEST(Stability, TheLimitIsWhereGrowthIsOneAndItRisesBeyond) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int n = 0; n < 60; ++n) {
    LoopModel loop = bare(0.03 + any(random), 0.01 + 2.0 * any(random), 1e-4 + 1e-3 * any(random),
                          static_cast<int>(3.99 * any(random)));
    if (n % 2 == 1) loop.hand = handPreset(n % 4 == 1 ? "relaxed" : "firm");
    if (n % 3 == 0) loop.device.lag = 1e-4 * any(random);
    const double damping = n % 5 == 0 ? 0.0 : 0.2 * any(random);
    const double k = largestStiffness(loop, damping);
    ASSERT_GT(k, 0.0) << n;
    EXPECT_LE(growthOf(loop, {0.999 * k, damping}), 1.0) << n;
    EXPECT_GT(growthOf(loop, {1.001 * k, damping}), 1.0) << n;
  }
}

TEST(Stability, WeightsOfVelocitiesAreWhatTheTrackerMakesOfReadings) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const double period = 1e-3;
  for (const VelocityEstimator estimator :
       {VelocityEstimator::kBackwardDifference, VelocityEstimator::kLeastSquares}) {
    const VelocitySettings settings{.estimator = estimator, .window = 8e-3};
    const std::vector<double> weights = velocityWeights(settings, period);
    VelocityTracker tracker(settings);
    std::vector<double> readings;
    Velocity last;
    for (int k = 0; k < 40; ++k) {
      readings.push_back(any(random));
      last = tracker.add(k * period, Vec3(readings.back(), 0.0, 0.0));
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      sum += weights[i] * readings[readings.size() - 1 - i];
    }
    EXPECT_NEAR(sum, last.value.x, 1e-9 * std::fabs(sum));
  }
}

TEST(Stability, SlowerVelocitiesLowerTheLimit) {
  // Simulated with m = b = 0.1, T = 1 ms, damping 2 and 10 N s/m.
  LoopModel loop = bare(0.1, 0.1, 1e-3);
  EXPECT_NEAR(largestStiffness(loop, 2.0), 4118.0, 1.0);
  EXPECT_NEAR(largestStiffness(loop, 10.0), 18280.0, 2.0);
  loop.velocity = {.estimator = VelocityEstimator::kLeastSquares, .window = 4e-3};
  EXPECT_NEAR(largestStiffness(loop, 2.0), 3662.0, 1.0);
  EXPECT_NEAR(largestStiffness(loop, 10.0), 11330.0, 2.0);
  loop.velocity.window = 15e-3;
  EXPECT_NEAR(largestStiffness(loop, 2.0), 1741.0, 1.0);
  EXPECT_NEAR(largestStiffness(loop, 10.0), 1903.0, 2.0);
}

TEST(Stability, PassivityIsTheConditionOfColgateAndSchenkel) {
  for (const double damping : {0.0, 0.1, 0.3}) {
    EXPECT_NEAR(passiveStiffness(bare(0.1, 0.5, 1e-3), damping), 2.0 * (0.5 - damping) / 1e-3,
                1e-6);
  }
  EXPECT_EQ(passiveStiffness(bare(0.1, 0.5, 1e-3), 0.6), 0.0);
  // With delay the spring's share is T / 2 times 1 + 2 cos(wT) + ... + 2 cos(d wT), which is
  // largest at w = 0.
  for (int delay = 1; delay < 4; ++delay) {
    const double expected = 2.0 * 0.5 / (1e-3 * (1.0 + 2.0 * delay));
    EXPECT_NEAR(passiveStiffness(bare(0.1, 0.5, 1e-3, delay)), expected, 1e-5 * expected);
  }
}

TEST(Stability, ATapIsQuietUpToTheSpeedThatFrictionCovers) {
  struct Case {
    const char* name;
    double without;  // [m/s] delay, on 1000 N/m
    double with;     // one sample
  };
  constexpr std::array kCases = {Case{"touch", 0.69, 0.22},       Case{"touch_x", 0.16, 0.05},
                                 Case{"premium_1_0", 0.10, 0.03}, Case{"omega_3", 1.9, 0.32},
                                 Case{"delta_3", 5.1, 0.46},      Case{"inverse3", 1.3, 0.29}};
  for (const Case& each : kCases) {
    LoopModel loop;
    loop.device = devicePreset(each.name).model();
    // 3 %: the numbers have two digits, and belong to the approximate limit.
    EXPECT_NEAR(quietSpeed(loop, {1000.0, 0.0}), each.without, 0.03 * each.without + 0.005);
    loop.delay = 1;
    EXPECT_NEAR(quietSpeed(loop, {1000.0, 0.0}), each.with, 0.03 * each.with + 0.005);
  }
  LoopModel quiet;
  quiet.device = devicePreset("excalibur").model();
  EXPECT_EQ(quietSpeed(quiet, {1000.0, 0.0}), kInfinity);
  quiet.device.friction = 0.0;  // damping alone suffices
  EXPECT_EQ(quietSpeed(quiet, {1000.0, 0.0}), kInfinity);
}

TEST(Stability, WhatDampingLacksMakesTheLoopJustStable) {
  LoopModel loop;
  loop.device = devicePreset("touch").model();
  const double missing = missingDamping(loop, {1000.0, 0.0});
  EXPECT_GT(missing, 0.0);
  loop.device.damping += missing;
  EXPECT_NEAR(largestStiffness(loop), 1000.0, 1e-3);
}

TEST(Stability, TheBudgetIsTheLesserOfItsTermsAndSaysWhich) {
  LoopModel loop;
  loop.device = devicePreset("touch_x").model();
  loop.hand = handPreset("relaxed");
  const StabilityBudget held = budgetOf(loop);
  EXPECT_NEAR(held.friction, 2.0 * 0.06 / 23e-6, 1e-6);  // 5217 N/m
  EXPECT_EQ(held.ruledBy(), BudgetTerm::kFriction);
  EXPECT_EQ(held.stiffness(), held.friction);
  loop.hand.reset();
  const StabilityBudget free = budgetOf(loop);
  EXPECT_EQ(free.ruledBy(), BudgetTerm::kLinear);
  EXPECT_EQ(free.stiffness(), 0.8 * free.linear);
  EXPECT_NEAR(free.passive, 2.0 * 0.01 / 1e-3, 1e-6);
  loop.device.friction = 0.0;
  EXPECT_EQ(budgetOf(loop).stiffness(), 0.0);  // the encoder's step causes chatter on any wall
  loop.device.encoder = 0.0;
  EXPECT_EQ(budgetOf(loop).friction, kInfinity);
}

TEST(Stability, RefusesLoopsThatCannotBe) {
  EXPECT_THROW((void)largestStiffness(bare(0.0, 1.0, 1e-3)), Error);
  EXPECT_THROW((void)largestStiffness(bare(0.1, -1.0, 1e-3)), Error);
  EXPECT_THROW((void)largestStiffness(bare(0.1, 1.0, 0.0)), Error);
  EXPECT_THROW((void)largestStiffness(bare(0.1, 1.0, 1e-3, -1)), Error);
  LoopModel weightless = bare(0.1, 1.0, 1e-3);
  weightless.hand.emplace();
  weightless.hand->grip_stiffness = 1.0;
  EXPECT_THROW((void)largestStiffness(weightless), Error);
}

}  // namespace
}  // namespace palpate::devices
