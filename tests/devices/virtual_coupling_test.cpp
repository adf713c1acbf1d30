#include "palpate/devices/virtual_coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/devices/coupling_design.h"
#include "support/alloc_guard.h"
#include "support/tiny_plant.h"

namespace palpate::devices {
namespace {

using testing::TinyPlant;

constexpr double kTick = 1e-3;  // [s]

LoopModel loopOf(double mass, double damping, int delay) {
  return {.device = {.mass = mass, .damping = damping}, .period = kTick, .delay = delay};
}

/// A flat wall at z = 0 with a spring and a damper that never pulls.
ToolForce wall(const ToolMotion& tool, double stiffness, double damping) {
  ToolForce out;
  if (tool.position.z >= 0.0) return out;
  out.normal = Vec3(0.0, 0.0, 1.0);
  out.stiffness = stiffness;
  out.damping = damping;
  out.force.z = std::max(0.0, -stiffness * tool.position.z - damping * tool.velocity.z);
  return out;
}

TEST(VirtualCoupling, InFreeMotionTheToolIsAtTheHandAndNothingIsFelt) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-0.1, 0.1);
  VirtualCoupling coupling({500.0, 3.0});
  for (int k = 0; k < 1000; ++k) {
    const Vec3 hand(any(random), any(random), any(random));
    const ToolMotion tool = coupling.reach(hand, kTick);
    // Rounding of positions of 0.1 m, which the damper carries on from tick to tick.
    EXPECT_LT(glm::length(tool.position - hand), 1e-14);
    EXPECT_LT(glm::length(coupling.push({})), 1e-10);
  }
}

TEST(VirtualCoupling, AWallAtRestIsASpringInSeries) {
  for (const double damping : {0.0, 4.0}) {
    VirtualCoupling coupling({500.0, damping});
    double force = 0.0;
    for (int k = 0; k < 3000; ++k) {
      const double z = -0.01 * std::min(1.0, k / 500.0);
      force = coupling.push(wall(coupling.reach(Vec3(0.02, 0.0, z), kTick), 2000.0, 5.0)).z;
    }
    EXPECT_NEAR(force, feltStiffness(2000.0, {500.0, damping}) * 0.01, 1e-12);
    EXPECT_DOUBLE_EQ(feltStiffness(2000.0, {500.0, damping}), 400.0);
  }
}

TEST(VirtualCoupling, InContactWithAFlatWallItIsBackwardEulerToRounding) {
  // The same equation solved by hand, for random motions inside the wall.
  std::mt19937 random(2);
  std::normal_distribution<double> push(0.0, 1.0);
  int judged = 0;
  for (int round = 0; round < 50; ++round) {
    const double kc = std::exp(4.0 + 2.0 * push(random));
    const double bc = std::exp(push(random));
    const double k = std::exp(6.0 + 2.0 * push(random));
    const double b = std::exp(push(random));
    VirtualCoupling coupling({kc, bc});
    double z = -0.01;
    double tool = 0.0;
    double before = 0.0;
    bool is_pressed = false;
    for (int n = 0; n < 300; ++n) {
      z += 1e-5 * push(random);
      const ToolForce answer = wall(coupling.reach(Vec3(0.0, 0.0, z), kTick), k, b);
      const double force = coupling.push(answer).z;
      // The wall's damper never pulls: in a tick in which it would pull, or after one, the two
      // solutions differ.
      const bool was_pressed = std::exchange(is_pressed, answer.force.z > 0.0);
      if (n >= 100 && is_pressed && was_pressed) {
        const double x = (kc * z + bc / kTick * (tool + z - before) + b / kTick * tool) /
                         (kc + (bc + b) / kTick + k);
        const double expected = kc * (x - z) + bc / kTick * ((x - tool) - (z - before));
        EXPECT_NEAR(force, expected, 1e-10 * (1.0 + std::fabs(expected))) << n;
        ++judged;
      }
      tool = coupling.tool().z;
      before = z;
    }
  }
  EXPECT_GT(judged, 5000);
}

TEST(VirtualCoupling, ItNeverPulls) {
  VirtualCoupling coupling({800.0, 5.0});
  for (int k = 0; k < 2000; ++k) {
    const double z = 0.003 * std::sin(0.05 * k);
    EXPECT_GE(coupling.push(wall(coupling.reach(Vec3(0.0, 0.0, z), kTick), 3000.0, 2.0)).z, 0.0);
  }
}

TEST(VirtualCoupling, ItIsTheSameWhereverTheWallIs) {
  // A hand that taps on a flat wall, at the origin and 1 km up or down: the scene is asked at the
  // same places relative to the wall, also at the ticks at which the hand lets go.
  constexpr double kFar = 1024.0;     // [m]
  constexpr double kRounding = 1e-9;  // [m] some ticks of 2e-13 each, which the spring adds up
  for (const double moved : {-kFar, kFar}) {
    VirtualCoupling here({800.0, 5.0});
    VirtualCoupling there({800.0, 5.0});
    const Vec3 shift(0.0, 0.0, moved);
    for (int k = 0; k < 2000; ++k) {
      const Vec3 hand(0.0, 0.0, 0.003 * std::sin(0.05 * k));
      const ToolMotion tool = here.reach(hand, kTick);
      ToolMotion other = there.reach(hand + shift, kTick);
      other.position -= shift;
      ASSERT_LT(glm::length(other.position - tool.position), kRounding) << k;
      const Vec3 force = here.push(wall(tool, 3000.0, 2.0));
      // 3000 N/m times the rounding, and as much again for the coupling's spring and damper.
      ASSERT_LT(glm::length(there.push(wall(other, 3000.0, 2.0)) - force), 1e4 * kRounding) << k;
    }
  }
}

TEST(VirtualCoupling, DragThicknessDoesNotMatter) {
  // A steady motion through a viscous medium: at first its drag is in series with the coupling's
  // damper, and after the spring has stretched the drag has the whole velocity of the device.
  for (const double viscosity : {1.0, 100.0, 1e4}) {
    VirtualCoupling coupling({200.0, 1.0});
    double force = 0.0;
    for (int k = 0; k < 400000; ++k) {
      const ToolMotion tool = coupling.reach(Vec3(1e-5 * k, 0.0, 0.0), kTick);
      ToolForce answer;
      answer.force = -viscosity * tool.velocity;
      answer.drag = viscosity;
      force = coupling.push(answer).x;
      EXPECT_LE(std::fabs(force), viscosity * 0.01 * (1.0 + 1e-9));
    }
    EXPECT_NEAR(force, -viscosity * 0.01, 1e-3 * viscosity * 0.01);
  }
}

TEST(VirtualCoupling, NeverAllocates) {
  VirtualCoupling coupling({800.0, 5.0});
  const testing::AllocGuard allocations;
  for (int k = 0; k < 100; ++k) {
    (void)coupling.push(wall(coupling.reach(Vec3(0.0, 0.0, -1e-5 * k), kTick), 3000.0, 2.0));
  }
  EXPECT_EQ(allocations.violations(), 0);
}

TEST(VirtualCoupling, RefusesWhatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const CouplingSettings& bad : {CouplingSettings{0.0, 1.0}, CouplingSettings{nan, 1.0},
                                      CouplingSettings{1.0, -1.0}, CouplingSettings{1.0, nan}}) {
    EXPECT_THROW(VirtualCoupling{bad}, Error);
  }
  EXPECT_THROW((void)couplingForSprings({.device = {.mass = 0.1}}), Error);
  EXPECT_THROW((void)couplingForAnyScene({.device = {.mass = 0.0, .damping = 0.1}}), Error);
}

TEST(CouplingDesign, ForAnySceneAsTheFrequencyResponseHasIt) {
  const double b = 0.3;
  const auto loop = [&](int delay) { return loopOf(0.2, b, delay); };
  for (int delay = 0; delay <= 3; ++delay) {
    const double ticks = 1.0 + delay;
    EXPECT_DOUBLE_EQ(stiffestForAnyScene(loop(delay), 0.0), 2.0 * b / kTick / (ticks * ticks));
  }
  // With an optimal damper the stiffness is 0.769, 0.483, 0.354 b / T, at 0.3 to 0.4 b. Without
  // delay no damper helps.
  EXPECT_EQ(couplingForAnyScene(loop(0)).damping, 0.0);
  const double best[] = {0.769, 0.483, 0.354};
  for (int delay = 1; delay <= 3; ++delay) {
    const CouplingSettings found = couplingForAnyScene(loop(delay));
    EXPECT_NEAR(found.stiffness * kTick / b, best[delay - 1], 0.002);
    EXPECT_GT(found.damping, 0.27 * b);
    EXPECT_LT(found.damping, 0.45 * b);
  }
  EXPECT_EQ(stiffestForAnyScene(loop(0), 1.01 * b), 0.0);
}

/// Largest deflection in the last quarter over that in the second, for a device alone on coupling
/// and spring.
double growth(const LoopModel& loop, const CouplingSettings& c, double spring) {
  TinyPlant plant({.mass = loop.device.mass, .damping = loop.device.damping}, loop.period, 1.0);
  const double slope = c.stiffness + c.damping / loop.period;
  double tool = c.stiffness / (c.stiffness + spring);
  double hand = 1.0;
  std::vector<double> line(static_cast<std::size_t>(loop.delay), 0.0);
  constexpr int kTicks = 4000;
  double early = 0.0;
  double late = 0.0;
  for (int k = 0; k < kTicks; ++k) {
    const double x = plant.position();
    const double loose = x + c.damping / loop.period / slope * (tool - hand);
    hand = x;
    tool = slope * loose / (slope + spring);
    line.push_back(slope * (tool - loose));
    plant.step(line.front(), 0.0);
    line.erase(line.begin());
    // An amplitude that does not depend on the phase.
    const double size = std::hypot(plant.position(), 0.01 * plant.velocity());
    if (k >= kTicks / 4 && k < kTicks / 2) early = std::max(early, size);
    if (k >= 3 * kTicks / 4) late = std::max(late, size);
  }
  return late / early;
}

double worstGrowth(const LoopModel& loop, const CouplingSettings& c) {
  double worst = 0.0;
  // Softer springs oscillate too slowly for 4 s, and are far from the limit for these devices.
  for (double power = -1.5; power <= 4.0; power += 0.5) {
    worst = std::max(worst, growth(loop, c, c.stiffness * std::pow(10.0, power)));
  }
  return worst;
}

TEST(CouplingDesign, ForSpringsTheWorstIsNotTheRigidWall) {
  const std::pair<double, double> devices[] = {{0.2, 0.3}, {1.5, 5.0}};
  for (const auto& [mass, damping] : devices) {
    for (const int delay : {0, 2}) {
      for (const double share : {0.004, 0.02, kCouplingDampingShare}) {
        const LoopModel loop = loopOf(mass, damping, delay);
        const double damper = share * mass / kTick;
        const double most = stiffestForSprings(loop, damper);
        EXPECT_LT(worstGrowth(loop, {0.95 * most, damper}), 1.0)
            << mass << " " << delay << " " << share;
        EXPECT_GT(worstGrowth(loop, {1.05 * most, damper}), 1.0)
            << mass << " " << delay << " " << share;
        // With a rigid wall alone, a stiffer coupling would be stable where the damper is above the
        // device's own.
        if (damper > 3.0 * damping) {
          EXPECT_LT(growth(loop, {1.05 * most, damper}, 1e9), 1.0);
        }
      }
      EXPECT_LT(worstGrowth(loopOf(mass, damping, delay),
                            couplingForSprings(loopOf(mass, damping, delay))),
                1.0);
    }
  }
}

}  // namespace
}  // namespace palpate::devices
