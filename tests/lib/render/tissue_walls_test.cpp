// Walls with nonlinear or relaxing springs, and friction that agrees with its ratio, at every tick
// rate.

#include <gtest/gtest.h>

#include "lib/render/drive.h"
#include "support/energy_meter.h"

namespace palpate::test {
namespace {

using testing::EnergyMeter;

std::string floorOf(const std::string& material) {
  return R"(
palpate: 1
length: mm
materials: {m: {)" +
         material + R"(}}
layers: [{name: floor, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: m}]
)";
}

TEST(TissueWalls, CurvedSpringsPushByTheirFormula) {
  Drive okamura(sceneOf(floorOf("stiffness: 40 N/m, curve: {stiffening: 2e4 N/m^2}")));
  Drive hertz(sceneOf(floorOf("stiffness: 800 N/m, curve: {exponent: 1.5, reference: 1 mm}")));
  for (double d = -1e-3; d < 8e-3; d += 0.1e-3) {
    const double depth = std::max(d, 0.0);
    EXPECT_NEAR(okamura.to(Vec3(0.0, 0.0, -d)).force.z, 40.0 * depth + 2e4 * depth * depth, 1e-9);
    EXPECT_NEAR(hertz.to(Vec3(0.0, 0.0, -d)).force.z, 0.8 * std::pow(depth / 1e-3, 1.5), 1e-9);
  }
}

TEST(TissueWalls, ACurvedSphereIsConservative) {
  Drive hand(sceneOf(R"(
palpate: 1
length: mm
materials: {m: {stiffness: 300 N/m, curve: {exponent: 2, reference: 2 mm, stiffening: 1e4 N/m^2}}}
layers: [{name: ball, inside: {sphere: {center: [0, 0, 0], radius: 30}}, wall: m}]
)"));
  EnergyMeter meter;
  // The hand goes in, sideways to another depth, and out. The way back through the air would cost
  // nothing, so the path counts as closed.
  double lowest = 0.0;
  const auto go = [&](double r0, double r1, double a0, double a1) {
    constexpr int kTicks = 4000;
    for (int i = 0; i <= kTicks; ++i) {
      const double s = i / static_cast<double>(kTicks);
      const double r = 1e-3 * (r0 + s * (r1 - r0));
      const double a = a0 + s * (a1 - a0);
      const Vec3 p(r * std::cos(a), 0.0, r * std::sin(a));
      meter.add(p, hand.to(p).force);
      lowest = std::min(lowest, meter.work());
    }
  };
  go(32, 26, 0.0, 0.0);
  go(26, 28, 0.0, 1.0);
  go(28, 32, 1.0, 1.0);
  EXPECT_LT(lowest, -2e-3);
  // A force held for a tick gives half of its change times the way: 6 mm in 4000 ticks at some 1000
  // N/m.
  EXPECT_NEAR(meter.work(), 0.0, 2e-5);
}

TEST(TissueWalls, AMaxwellBranchIsARampAndARelaxation) {
  Drive hand(sceneOf(floorOf("stiffness: 500 N/m, maxwell: {stiffness: 300 N/m, time: 20 ms}")));
  (void)hand.to(Vec3(0.0, 0.0, 0.0));
  const double step = 20e-6;
  double z = 0.0;
  for (int i = 1; i <= 100; ++i) {
    z -= step;
    const double t = i * Drive::kTick;
    const double speed = step / Drive::kTick;
    const double branch = 300.0 * speed * 0.02 * -std::expm1(-t / 0.02);
    EXPECT_NEAR(hand.to(Vec3(0.0, 0.0, z)).force.z, -500.0 * z + branch, 1e-9);
  }
  const double held = hand.last().force.z + 500.0 * z;
  for (int i = 1; i <= 100; ++i) {
    EXPECT_NEAR(hand.to(Vec3(0.0, 0.0, z)).force.z,
                -500.0 * z + held * std::exp(-i * Drive::kTick / 0.02), 1e-9);
  }
  // Drawn back quickly, the wall does not hold on to the hand.
  for (double up = z; up < 0.5e-3; up += 0.2e-3) {
    EXPECT_GE(hand.to(Vec3(0.0, 0.0, up)).force.z, 0.0);
  }
}

// When the hand is lifted fast, the branch slackens where it would pull as hard as the wall's own
// spring pushes; from there on it acts again.
TEST(TissueWalls, AMaxwellBranchSlackensRatherThanPull) {
  constexpr double kOwn = 500.0;      // [N/m]
  constexpr double kBranch = 2000.0;  // [N/m]
  const auto renderer = makeRenderer(
      sceneOf(floorOf("stiffness: 500 N/m, maxwell: {stiffness: 2000 N/m, time: 1000 s}")));
  const auto press = [&](double depth, double dt) {
    return renderer->update({Vec3(0.0, 0.0, -depth), Vec3(0.0), dt}).force.z;
  };
  (void)press(-1e-3, 1e-3);
  (void)press(2e-3, 1e-3);
  // Relaxed: its dashpot has given way by the whole depth.
  EXPECT_NEAR(press(2e-3, 1e6), kOwn * 2e-3, 1e-9);
  EXPECT_NEAR(press(0.1e-3, 1e-6), 0.0, 1e-9);
  // There the branch, stretched by -0.025 mm, was in balance with the wall's spring, both at 0.05
  // N. The hand then presses by 0.9 mm more.
  EXPECT_NEAR(press(1e-3, 1e-6), kOwn * 1e-3 + kBranch * (0.9e-3 - kOwn * 0.1e-3 / kBranch), 1e-6);
}

TEST(TissueWalls, AMaxwellBranchTakesEnergyAndGivesNone) {
  Drive hand(sceneOf(floorOf("stiffness: 500 N/m, maxwell: {stiffness: 300 N/m, time: 20 ms}")));
  EnergyMeter meter;
  double leak = 0.0;
  double before = 1e-3;
  double force = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double z = 1e-3 - 3e-3 * std::sin(0.011 * i) * std::sin(0.0037 * i);
    const Vec3 p(0.0, 0.0, z);
    const double now = hand.to(p).force.z;
    leak += std::fabs(now - force) * std::fabs(z - before);
    before = z;
    force = now;
    meter.add(p, hand.last().force);
    ASSERT_LE(meter.gained(), leak);
  }
  EXPECT_LT(meter.work() + leak, -1e-3);
}

// SOFA's `frictionCoeff` changed with the solver's iterations: the same value gave 0.08 N and 51 N.
TEST(TissueWalls, AFrictionRatioIsTheRatioAtEveryRate) {
  for (const double dt : {2e-3, 1e-3, 2.5e-4, 1e-4}) {
    for (const char* spring : {"", ", curve: {stiffening: 5e4 N/m^2}"}) {
      const auto renderer = makeRenderer(sceneOf(floorOf(
          std::string("stiffness: 1000 N/m, friction: {static: 0.5, kinetic: 0.3}") + spring)));
      const double depth = 3e-3;
      TickResult r;
      double highest = 0.0;
      const double speed = 0.05;
      for (double x = 0.0; x < 0.02; x += speed * dt) {
        r = renderer->update({Vec3(x, 0.0, -depth), Vec3(speed, 0.0, 0.0), dt});
        highest = std::max(highest, -r.force.x / r.force.z);
      }
      EXPECT_NEAR(-r.force.x / r.force.z, 0.3, 1e-6) << dt << spring;
      // The proxy breaks away at the static ratio, measured to within a tick's way.
      EXPECT_NEAR(highest, 0.5, speed * dt / depth + 1e-6) << dt << spring;
      EXPECT_LE(highest, 0.5 + 1e-6);
    }
  }
}

// The same motion gives the same force at any tick rate: nothing in it is an impulse.
TEST(TissueWalls, TheForceOfAMotionDoesNotDependOnTheTick) {
  const ScenePtr scene = sceneNamed("slab");
  const auto run = [&](double dt) {
    std::vector<Vec3> out;
    const auto renderer = makeRenderer(scene);
    const double speed = 0.05;
    const int every = static_cast<int>(std::lround(2e-3 / dt));
    for (int i = 0; i * dt < 0.9; ++i) {
      const double depth = -0.002 + speed * dt * i;
      const TickResult r = renderer->update({Vec3(0.0, 0.0, -depth), Vec3(0.0, 0.0, -speed), dt});
      if (i % every == 0) out.push_back(r.force);
    }
    return out;
  };
  const std::vector<Vec3> coarse = run(2e-3);
  const std::vector<Vec3> fine = run(1e-4);
  ASSERT_EQ(coarse.size(), fine.size());
  int differ = 0;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    if (glm::distance(coarse[i], fine[i]) > 1e-9) ++differ;
  }
  // The forces differ only right after a puncture, whose time is known only to within a tick.
  EXPECT_LE(differ, 3);
}

// SOFA's shipped scenes were practically without friction.
TEST(TissueWalls, TheNeedleScenesHaveFriction) {
  const ScenePtr scene = sceneNamed("slab");
  int tissues = 0;
  for (const Region& region : scene->regions()) {
    if (region.wall >= 0 && region.name != "fat") {
      const Material& wall = scene->materials()[static_cast<std::size_t>(region.wall)];
      EXPECT_GT(wall.friction.static_ratio.at(Vec3(0.0)), 0.1) << region.name;
      EXPECT_GT(wall.friction.kinetic_ratio.at(Vec3(0.0)), 0.1) << region.name;
    }
    if (region.content < 0) continue;
    ++tissues;
    const Material& tissue = scene->materials()[static_cast<std::size_t>(region.content)];
    EXPECT_GT(tissue.shaft.stiffness, 0.0) << region.name;
    for (const ShaftFriction::Way* way : {&tissue.shaft.in, &tissue.shaft.out}) {
      EXPECT_GT(way->kinetic_force.at(Vec3(0.0)), 1.0) << region.name;
      EXPECT_GT(way->static_force.at(Vec3(0.0)), way->kinetic_force.at(Vec3(0.0))) << region.name;
    }
  }
  EXPECT_EQ(tissues, 3);
}

}  // namespace
}  // namespace palpate::test
