// Contents: the lattice of data/scenes against its formula, contents changed while running, and the
// energy of contents that are sources.

#include "palpate/render/contents.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "lib/render/drive.h"
#include "support/alloc_guard.h"
#include "support/energy_meter.h"
#include "support/test_maps.h"

namespace palpate::test {
namespace {

using testing::AllocGuard;
using testing::EnergyMeter;

constexpr double kPi = std::numbers::pi;

// data/scenes/lattice.yaml: 0.4 N, 8 x 8 x 12 mm.
Vec3 latticeAt(const Vec3& p) {
  return -0.4 * Vec3(std::sin(2.0 * kPi * p.x / 8e-3), std::sin(2.0 * kPi * p.y / 8e-3),
                     std::sin(2.0 * kPi * p.z / 12e-3));
}

TEST(Contents, LatticeSceneIsItsFormula) {
  for (const RendererKind kind : {RendererKind::kConstraint, RendererKind::kPaper}) {
    Drive hand(sceneNamed("lattice"), kind);
    const Vec3 from = mm(3, -7, 30);
    const Vec3 to = mm(-11, 13, -15);
    int compared = 0;
    Vec3 before = from;
    for (int i = 0; i <= 1000; ++i) {
      const Vec3 p = from + (i / 1000.0) * (to - from);
      const TickResult r = hand.to(p);
      const Vec3 velocity = (p - before) / Drive::kTick;
      before = p;
      if (p.z > 18e-3) {
        EXPECT_EQ(r.force, Vec3(0.0));
      } else if (p.z < 17.7e-3) {  // a quarter of a millimeter below the mouth the drag is full
        EXPECT_TRUE(isNear(r.force, latticeAt(p) - 0.5 * velocity, 1e-12)) << i;
        ++compared;
      }
    }
    EXPECT_GT(compared, 700);
  }
}

TEST(Contents, OnAWallTheLatticePushesAlongItOnly) {
  Drive hand(sceneNamed("lattice"));
  (void)hand.walk(mm(1, 2, 30));
  (void)hand.walk(mm(1, 2, -22));  // 2 mm into the floor
  EXPECT_TRUE(hand.last().contact);
  const Vec3 lattice = latticeAt(mm(1, 2, 0));
  EXPECT_TRUE(isNear(hand.last().force, Vec3(lattice.x, lattice.y, 1500.0 * 2e-3), 1e-9));
}

// A tank open above, whose lattice does not fade: on the way in and out again the potential may
// differ.
const char* const kTank = R"(
palpate: 1
length: mm
materials: {grid: {stiffness: 400 N/m, lattice: {force: 0.4 N, wavelength: [8, 8, 12], origin: [1, 0, 3]}}}
layers: [{name: tank, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, content: grid}]
ports: [{name: mouth, between: [outside, tank]}]
)";

// [J] Potential of kTank's lattice.
double potential(const Vec3& p) {
  const Vec3 lengths(8e-3, 8e-3, 12e-3);
  const Vec3 from_origin = p - mm(1, 0, 3);
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double k = 2.0 * kPi / lengths[i];
    sum += 0.4 / k * (1.0 - std::cos(k * from_origin[i]));
  }
  return sum;
}

TEST(Contents, ALatticeIsConservativeInsideAndCountedWhereItIsNot) {
  std::mt19937 random(6);
  std::normal_distribution<double> push(0.0, 1.0);
  Drive hand(sceneOf(kTank));
  EnergyMeter meter;
  Vec3 p(0.0, 0.0, 0.004);
  Vec3 v(0.0);
  Vec3 last_force(0.0);
  double leak = 1e-12;
  double most = 0.0;
  int crossings = 0;
  for (int i = 0; i < 60000; ++i) {
    v += 0.1e-6 * Vec3(push(random), push(random), push(random));
    v -= 0.25e-6 * p + 0.001 * v;
    p += v;
    const TickResult r = hand.to(p);
    // A changing force that is held for a tick is wrong by half of its change on average; where it
    // jumps, within the tick that crosses the mouth, by up to the whole change.
    const double change = glm::length(r.force - last_force);
    leak += (r.event_count > 0 ? 1.0 : 0.6) * change * glm::length(v);
    crossings += r.event_count;
    last_force = r.force;
    meter.add(p, r.force);
    const double source = hand.renderer().sourceWork();
    most = std::max(most, std::fabs(source));
    // The work on the hand equals the work of sources minus the potential that the lattice holds.
    const double held = r.region == kOutside ? 0.0 : potential(p);
    ASSERT_NEAR(meter.work(), source - held, leak) << i;
  }
  EXPECT_GT(crossings, 4);
  // The energies gained and lost at crossings are far larger than the error of the account.
  EXPECT_LT(leak, 0.5 * most);
}

TEST(Contents, AFlowGivesWorkAndItIsCounted) {
  Drive hand(sceneOf(R"(
palpate: 1
length: mm
materials: {river: {viscosity: 4 N.s/m, flow: [100 mm/s, 0 mm/s, 0 mm/s]}}
layers: [{name: river, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, content: river}]
ports: [{name: bank, between: [outside, river]}]
)"));
  EnergyMeter meter;
  // The hand moves with the flow in the river, slower than the flow, and back through the air. In
  // each round the flow pushes the hand along.
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i <= 1000; ++i) {
      const Vec3 p = mm(-20 + 0.04 * i, 0, -5);
      meter.add(p, hand.to(p).force);
    }
    for (int i = 0; i <= 1000; ++i) {
      const Vec3 p = mm(20 - 0.04 * i, 0, 5);
      meter.add(p, hand.to(p).force);
    }
  }
  EXPECT_GT(meter.work(), 0.02);
  const double source = hand.renderer().sourceWork();
  EXPECT_GT(source, meter.work());
  // The full force is 4 N s/m * 0.1 m/s = 0.4 N along 40 mm, five times; it is still fading in
  // along the first quarter millimeter of each.
  EXPECT_NEAR(source, 5 * 0.4 * 0.04, 5 * 0.4 * 0.5e-3);
  hand.renderer().reset();
  EXPECT_EQ(hand.renderer().sourceWork(), 0.0);
}

TEST(Contents, AreChangedWhileRunning) {
  const ScenePtr scene = sceneNamed("container");
  Drive hand(scene);
  const RegionId liquid = scene->regionNamed("liquid");
  (void)hand.walk(mm(0, 0, 30));
  (void)hand.walk(mm(0, 0, 0));
  const auto drag = [&] {
    (void)hand.to(mm(0, 0, 0));
    return hand.to(mm(0.05, 0, 0)).force;
  };
  EXPECT_TRUE(isNear(drag(), Vec3(-4.0 * 0.05, 0.0, 0.0), 1e-12));
  EXPECT_TRUE(hand.renderer().setContent(liquid, {.viscosity = 10.0}));
  EXPECT_TRUE(isNear(drag(), Vec3(-10.0 * 0.05, 0.0, 0.0), 1e-12));
  EXPECT_TRUE(hand.renderer().setContent(liquid, {.viscosity = 1.0, .flow = Vec3(0.0, 0.2, 0.0)}));
  EXPECT_TRUE(isNear(drag(), Vec3(-0.05, 0.2, 0.0), 1e-12));
  // An invalid change is refused and changes nothing.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(hand.renderer().setContent(liquid, {.viscosity = -1.0}));
  EXPECT_FALSE(hand.renderer().setContent(liquid, {.viscosity = nan}));
  EXPECT_FALSE(hand.renderer().setContent(liquid, {.flow = Vec3(nan, 0.0, 0.0)}));
  EXPECT_FALSE(hand.renderer().setContent(liquid, {.lattice_force = 0.1}));
  EXPECT_FALSE(hand.renderer().setContent(liquid, {.cutting = 0.1}));
  EXPECT_FALSE(hand.renderer().setContent(99, {.viscosity = 1.0}));
  EXPECT_TRUE(isNear(drag(), Vec3(-0.05, 0.2, 0.0), 1e-12));
  EXPECT_TRUE(hand.renderer().setContent(liquid, {}));
  EXPECT_TRUE(isNear(drag(), Vec3(-4.0 * 0.05, 0.0, 0.0), 1e-12));
}

TEST(Contents, LatticeAndCuttingAreChangedWithinTheirLimits) {
  const ScenePtr lattice = sceneNamed("lattice");
  Drive hand(lattice);
  (void)hand.walk(mm(2, 0, 30));
  (void)hand.walk(mm(2, 0, 6));
  EXPECT_TRUE(isNear(hand.last().force, Vec3(-0.4, 0.0, 0.0), 1e-9));
  const RegionId grid = lattice->regionNamed("grid");
  EXPECT_TRUE(hand.renderer().setContent(grid, {.lattice_force = 0.1}));
  EXPECT_TRUE(isNear(hand.to(mm(2, 0, 6)).force, Vec3(-0.1, 0.0, 0.0), 1e-9));
  EXPECT_FALSE(hand.renderer().setContent(grid, {.lattice_force = 0.41}));  // 320 N/m * 8 mm / 2 pi
  const ScenePtr slab = sceneNamed("slab");
  Drive needle(slab);
  EXPECT_TRUE(needle.renderer().setContent(slab->regionNamed("fat"), {.cutting = 0.0}));
  (void)needle.walk(mm(0, 0, 5));
  (void)needle.walk(mm(0, 0, -12), 50e-6);
  // At rest: the friction of 2 mm of skin and 10 mm of fat, and no cutting.
  EXPECT_NEAR(needle.last().force.z, 2e-3 * 16 + 10e-3 * 3, 1e-6);
}

// Properties of a needle's tissue vary, by a given amount per meter along its way.
TEST(Contents, WhatHoldsANeedleMayVaryFromPlaceToPlace) {
  SceneDescription description = parseScene(R"(
palpate: 1
length: mm
materials:
  jelly: {stiffness: 300 N/m, shaft: {stiffness: 1e5 N/m^2, in: {static: 1 N/m}}}
layers: [{name: jelly, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, content: jelly}]
ports: [{name: top, between: [outside, jelly]}]
)",
                                            "test.yaml");
  Material& jelly = description.materials.at(0);
  jelly.cutting = testing::linearMap(0.2, Vec3(0.0, 0.0, -10.0), {0.0, 10.0});
  jelly.shaft.in.static_force = testing::linearMap(8.0, Vec3(0.0, 0.0, -500.0), {0.0, 100.0});
  jelly.shaft.in.kinetic_force = testing::linearMap(5.0, Vec3(0.0, 0.0, -400.0), {0.0, 100.0});
  Drive hand(compile(description));
  (void)hand.walk(mm(0, 0, 2));
  for (double z = 2.0; z > -20.0; z -= 0.05) {
    const double depth = -1e-3 * z;
    const double force = hand.to(mm(0, 0, z)).force.z;
    if (depth < 2e-3) continue;  // pressed, but not yet sliding
    // The cutting force at the tip, and the friction of each slice of the shaft: 5 N/m + 400 N/m^2
    // s.
    EXPECT_NEAR(force, 0.2 + 10.0 * depth + 5.0 * depth + 200.0 * depth * depth, 1e-9);
  }
}

TEST(Contents, NeedlesLatticesAndChangesNeitherAllocateNorLock) {
  for (const char* name : {"slab", "lattice"}) {
    const ScenePtr scene = sceneNamed(name);
    const auto renderer = makeRenderer(scene);
    (void)renderer->update({mm(0, 0, 30)});
    const AllocGuard guard;
    double z = 0.030;
    for (int round = 0; round < 4; ++round) {
      for (int i = 0; i < 800; ++i) {
        z += round % 2 == 0 ? -0.1e-3 : 0.1e-3;
        (void)renderer->update({Vec3(0.0, 1e-4 * round, z), Vec3(0.0, 0.0, 0.1)});
        if (i % 10 == 0) (void)renderer->setContent(1, {.viscosity = 0.01 * i});
      }
    }
    EXPECT_EQ(guard.violations(), 0) << name;
  }
}

}  // namespace
}  // namespace palpate::test
