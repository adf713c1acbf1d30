// The parts of a scene that a device can hold: every kind of item that can be felt, and remedies
// that suffice.

#include "palpate/devices/scene_budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palpate/devices/device_presets.h"
#include "palpate/devices/session.h"
#include "palpate/scene/scene_file.h"

namespace palpate::devices {
namespace {

constexpr const char* kScene = R"(
palpate: 1
length: mm
materials:
  hard: {stiffness: 40000 N/m, damping: 2 N.s/m}
  soft: {stiffness: 200 N/m}
  grid: {stiffness: 400 N/m, viscosity: 1 N.s/m, lattice: {force: 0.4 N, wavelength: [8, 0, 12]}}
  curved: {stiffness: 100 N/m, curve: {stiffening: 4e4 N/m^2}}
  rough: {stiffness: 500 N/m, texture: {amplitude: 0.1, wavelength: 2}}
  flesh: {stiffness: 150 N/m, cutting: 0.5 N, shaft: {stiffness: 1e5 N/m^2, in: {static: 18 N/m, kinetic: 10 N/m, damping: 20 N.s/m^2}, lateral: {stiffness: 3e4 N/m^2}}}
  syrup: {viscosity: 400 N.s/m}
layers:
  - {name: box, inside: {box: {center: [0, 0, 0], size: [40, 40, 40]}}, content: grid, wall: hard}
  - {name: ball, inside: {sphere: {center: [100, 0, 0], radius: 10}}, wall: soft}
  - {name: fruit, inside: {sphere: {center: [200, 0, 0], radius: 15}}, content: flesh, wall: curved}
  - {name: stone, inside: {sphere: {center: [300, 0, 0], radius: 10}}, wall: rough}
  - {name: pot, inside: {sphere: {center: [0, 100, 0], radius: 10}}, content: syrup, wall: absent}
  - {name: safe, inside: {sphere: {center: [0, 0, 100], radius: 10}}, content: syrup, wall: soft}
ports:
  - {name: lid, between: [outside, box]}
  - {name: skin, between: [outside, fruit], opens_at: 1 N}
)";

ScenePtr scene(const std::string& device = "") {
  return compile(parseScene(std::string(kScene) + device, "budget.yaml"));
}

const FeltItem* find(const std::vector<FeltItem>& items, const std::string& material,
                     const std::string& parameter) {
  for (const FeltItem& each : items) {
    if (each.material == material && each.parameter == parameter) return &each;
  }
  return nullptr;
}

TEST(SceneBudget, FindsAllThatIsFeltAsStiffAsItGets) {
  DeviceModel device = devicePreset("omega_3").model();  // 12 N
  const std::vector<FeltItem> items = feltItems(*scene(), device);
  const auto expect = [&](const char* material, const char* parameter, double stiffness,
                          double damping) {
    const FeltItem* item = find(items, material, parameter);
    ASSERT_NE(item, nullptr) << material << "." << parameter;
    EXPECT_NEAR(item->most.stiffness, stiffness, 1e-9 * stiffness) << material << "." << parameter;
    EXPECT_NEAR(item->most.damping, damping, 1e-9 * damping) << material << "." << parameter;
  };
  expect("hard", "stiffness", 40000.0, 2.0);
  expect("soft", "stiffness", 200.0, 0.0);
  expect("grid", "viscosity", 0.0, 1.0);
  expect("grid", "lattice", 2.0 * std::numbers::pi * 0.4 / 8e-3, 1.0);
  // 100 d + 4e4 d^2 = 12 N, slope 100 + 8e4 d.
  const double d = (-100.0 + std::sqrt(1e4 + 4.0 * 4e4 * 12.0)) / 8e4;
  expect("curved", "curve", 100.0 + 8e4 * d, 0.0);
  expect("rough", "stiffness", 500.0 * (1.0 + 0.1 * std::numbers::pi), 0.0);
  expect("flesh", "cutting", 150.0, 0.0);
  const double length = 0.03 * std::sqrt(3.0);  // the box of a ball of 15 mm
  expect("flesh", "shaft", 1e5 * length, 20.0 * length);
  expect("flesh", "shaft.lateral", 3e4 * length, 0.0);
  expect("syrup", "viscosity", 0.0, 400.0);
  // From inside, the safe cannot be felt: no port leads there.
  EXPECT_EQ(find(items, "syrup", "viscosity")->places, std::vector<std::string>{"pot"});
  EXPECT_EQ(find(items, "hard", "stiffness")->places,
            (std::vector<std::string>{"box | outside", "outside | box"}));
  EXPECT_EQ(find(items, "soft", "stiffness")->places,
            (std::vector<std::string>{"outside | ball", "outside | safe"}));
}

TEST(SceneBudget, IsOfTheStiffnessAtTheHand) {
  const DeviceModel device = devicePreset("omega_3").model();
  const std::vector<FeltItem> plain = feltItems(*scene(), device);
  const std::vector<FeltItem> mapped =
      feltItems(*scene("device: {scale: 2, force: 0.25}\n"), device);
  EXPECT_NEAR(find(mapped, "soft", "stiffness")->most.stiffness, 100.0, 1e-9);
  EXPECT_NEAR(find(mapped, "syrup", "viscosity")->most.damping, 200.0, 1e-9);
  // The motors' 12 N are 48 N in the world.
  EXPECT_GT(find(mapped, "curved", "curve")->most.stiffness / 0.5,
            find(plain, "curved", "curve")->most.stiffness);
}

TEST(SceneBudget, AWallWithoutEndFarFromTheOtherLayersIsFoundToo) {
  const ScenePtr felt = compile(parseScene(R"(
palpate: 1
length: mm
materials:
  skin: {stiffness: 400 N/m, composite: {radius: 5, depth: 120}}
  knot: {stiffness: 4000 N/m}
layers:
  - {name: tissue, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}
  - {name: lump, inside: {sphere: {center: [0, 0, -30], radius: 5}}, wall: knot}
)",
                                           "lump.yaml"));
  const std::vector<FeltItem> items = feltItems(*felt, devicePreset("touch").model());
  ASSERT_EQ(items.size(), 1U);
  EXPECT_EQ(items[0].material, "skin");
  EXPECT_EQ(items[0].parameter, "composite");
  // Through the skin, the stiffest wall of all may be felt.
  EXPECT_EQ(items[0].most.stiffness, 4000.0);
}

LoopModel touchLoop() {
  LoopModel loop;
  loop.device = devicePreset("touch").model();
  loop.hand = handPreset("relaxed");
  return loop;
}

TEST(SceneBudget, WhatIsAboveIsSoByTheBudgetAndTheCuresCureIt) {
  LoopModel loop = touchLoop();
  loop.hand.reset();
  int above = 0;
  for (const BudgetItem& each : sceneBudget(*scene(), loop)) {
    const WallModel& wall = each.item.most;
    const std::string what = each.item.material + "." + each.item.parameter;
    const bool is_spring = wall.stiffness > 0.0;
    const double budget = is_spring ? budgetOf(loop, wall.damping).stiffness()
                                    : StabilityBudget::kShare * largestDamping(loop);
    EXPECT_DOUBLE_EQ(each.allowed, budget) << what;
    EXPECT_EQ(each.isAbove(), (is_spring ? wall.stiffness : wall.damping) > budget) << what;
    if (!each.isAbove()) continue;
    ++above;
    const auto fits = [&](const LoopModel& by, double share) {
      const WallModel less{share * wall.stiffness, share * wall.damping};
      return is_spring ? less.stiffness <= budgetOf(by, less.damping).stiffness() * (1.0 + 1e-9)
                       : less.damping <= StabilityBudget::kShare * largestDamping(by);
    };
    if (std::isfinite(each.rate)) {
      LoopModel faster = loop;
      faster.period = 1.0 / each.rate;
      EXPECT_TRUE(fits(faster, 1.0)) << what;
      faster.period = 1.05 / each.rate;
      EXPECT_FALSE(fits(faster, 1.0)) << what;
    }
    ASSERT_GT(each.force, 0.0) << what;
    EXPECT_TRUE(fits(loop, each.force)) << what;
    EXPECT_FALSE(fits(loop, 1.01 * each.force)) << what;
    for (const HandPreset& hand : handPresets()) {
      LoopModel held = loop;
      held.hand = hand.model;
      const bool is_listed = std::count(each.hands.begin(), each.hands.end(), hand.name) > 0;
      EXPECT_EQ(is_listed, fits(held, 1.0)) << what << " " << hand.name;
    }
    if (is_spring) {
      LoopModel damped = loop;
      damped.device.damping += each.missing_damping;
      EXPECT_LE(growthOf(damped, wall), 1.0 + 1e-9) << what;
    }
  }
  EXPECT_GE(above, 5);
}

TEST(SceneBudget, ASessionWarnsAtSetUpAndChangesNothing) {
  const ScenePtr felt = scene();
  SessionSettings settings;
  settings.loop = touchLoop();
  settings.loop->period = 1.0;  // is replaced by the session's own
  const Session warned(felt, settings);
  ASSERT_FALSE(warned.overBudget().empty());
  EXPECT_EQ(warned.overBudget().front().item.material, "hard");
  EXPECT_EQ(warned.overBudget().front().budget.linear, largestStiffness(touchLoop(), 2.0));
  for (const BudgetItem& each : warned.overBudget()) EXPECT_TRUE(each.isAbove());
  const Session silent(felt);
  EXPECT_TRUE(silent.overBudget().empty());
  settings.servo.rate = 20000.0;
  const Session faster(felt, settings);
  EXPECT_LT(faster.overBudget().size(), warned.overBudget().size());
}

}  // namespace
}  // namespace palpate::devices
