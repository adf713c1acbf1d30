// The whole program with passivity control or a virtual coupling, on walls far above the device's
// budget.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/devices/coupling_design.h"
#include "palpate/devices/device_presets.h"
#include "palpate/devices/hand_guards.h"
#include "palpate/devices/session.h"
#include "palpate/devices/simulated_device.h"
#include "palpate/scene/scene_file.h"
#include "support/alloc_guard.h"

namespace palpate::devices {
namespace {

constexpr double kTick = 1e-3;  // [s]

/// A scene touched from above at the origin. `device`: the guards that the scene asks for.
ScenePtr sceneOf(const std::string& shape, double stiffness, const std::string& device = {}) {
  std::ostringstream text;
  text.precision(17);
  text << "palpate: 1\nlength: mm\nmaterials:\n  wall: {stiffness: " << stiffness
       << " N/m}\nlayers:\n  - {name: body, inside: " << shape << ", wall: wall}\n"
       << device;
  return compile(parseScene(text.str(), "guarded.yaml"));
}

const std::string kFlat = "{half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}";
const std::string kBall = "{sphere: {center: [0, 0, -20], radius: 20}}";

LoopModel loopOf(const std::string& device, int delay = 0) {
  LoopModel loop;
  loop.device = devicePreset(device).model();
  loop.hand = handPreset("relaxed");
  loop.period = kTick;
  loop.delay = delay;
  return loop;
}

struct Felt {
  double to_hand = 0.0;     ///< [J] largest energy given to the hand so far
  double tick_cost = 0.0;   ///< [J] K (v T)^2 + F v T of the largest speed and force so far
  double beyond = 0.0;      ///< [J] largest excess of `to_hand` over that at any tick
  double chatter = 0.0;     ///< [N] peak to peak along the normal, in the last half second
  double stiffness = 0.0;   ///< [N/m] mean force over mean depth, in the same time
  double most_added = 0.0;  ///< [N] largest force by the controller
  std::int64_t violations = 0;
};

/// A relaxed hand presses with about 3 N, reached within a second or (`taps`) at 0.5 m/s, and holds
/// for a second or more.
Felt press(const ScenePtr& scene, double stiffness, const LoopModel& loop, bool taps = false) {
  SimulationSettings settings{
      .device = loop.device, .hand = loop.hand, .rate = 1.0 / loop.period, .delay = loop.delay};
  const double there = taps ? 13e-3 / 0.5 : 1.0;  // [s]
  const Path path = {
      {0.0, Vec3(0.0, 0.0, 1e-3)}, {there, Vec3(0.0, 0.0, -12e-3)}, {2.0, Vec3(0.0, 0.0, -12e-3)}};
  SimulatedDevice device(settings, path, DeviceFrame::kDevice);
  SessionSettings how;
  how.servo.rate = 1.0 / loop.period;
  how.loop = loop;
  Session session(scene, how);
  Felt out;
  std::vector<double> forces;
  forces.reserve(10000);
  double depth = 0.0;
  double longest = 0.0;
  double strongest = 0.0;
  Vec3 last(0.0);
  device.open();
  DeviceState state;
  const testing::AllocGuard guard;
  while (device.read(state) == DeviceStatus::kOk) {
    const SessionTick tick = session.step(state, DeviceFrame::kDevice);
    if (tick.number > 0) longest = std::max(longest, glm::distance(state.position, last));
    last = state.position;
    (void)device.write(tick.force);
    strongest = std::max(strongest, glm::length(device.heldForce()));
    out.to_hand = std::max(out.to_hand, device.work().given());
    out.tick_cost = stiffness * longest * longest + strongest * longest;
    out.beyond = std::max(out.beyond, out.to_hand - out.tick_cost);
    out.most_added = std::max(out.most_added, glm::length(tick.added));
    if (state.time < 1.5) continue;
    forces.push_back(device.heldForce().z);
    depth -= state.position.z;
  }
  out.violations = guard.violations();
  device.close();
  const auto [low, high] = std::minmax_element(forces.begin(), forces.end());
  out.chatter = *high - *low;
  double sum = 0.0;
  for (const double force : forces) sum += force;
  out.stiffness = sum / depth;
  return out;
}

/// Two versions of a loop: with the device as it is, and with its linear part, where no friction
/// hides a growing oscillation.
std::vector<LoopModel> loopsOf(const std::string& device) {
  std::vector<LoopModel> both(2, loopOf(device));
  both[1].device.friction = 0.0;
  both[1].device.encoder = 0.0;
  both[1].device.max_force = kInfinity;
  return both;
}

/// Calls `each` with a wall `times` as stiff as the budget, a plane or a ball, pressed or tapped.
template <class Each>
void eachWall(const LoopModel& loop, const std::vector<double>& times, const Each& each) {
  for (const std::string* shape : {&kFlat, &kBall}) {
    for (const double factor : times) {
      for (const bool taps : {false, true}) {
        each(*shape, factor * budgetOf(loop).stiffness(), taps);
      }
    }
  }
}

TEST(GuardedLoop, ACouplingHoldsTenTimesTheBudget) {
  for (const char* name : {"excalibur", "falcon", "touch", "omega_3"}) {
    for (const LoopModel& loop : loopsOf(name)) {
      const bool is_linear = loop.device.friction == 0.0;
      const CouplingSettings coupling = couplingForSprings(loop);
      eachWall(loop, {2.0, 10.0}, [&](const std::string& shape, double wall, bool taps) {
        const Felt plain = press(sceneOf(shape, wall), wall, loop, taps);
        const Felt coupled =
            press(sceneOf(shape, wall, "device: {coupling: {}}\n"), wall, loop, taps);
        const Felt both = press(sceneOf(shape, wall, "device: {coupling: {}, passivity: {}}\n"),
                                wall, loop, taps);
        const std::string what = std::string(name) + (is_linear ? " linear, " : ", ") +
                                 (shape == kFlat ? "flat, " : "ball, ") +
                                 (taps ? "tap, " : "press, ") + std::to_string(wall) + " N/m";
        std::printf(
            "%s: hand %.2g J, coupled %.2g J; chatter %.2g N, coupled %.2g N; felt %.4f of %.4f\n",
            what.c_str(), plain.to_hand, coupled.to_hand, plain.chatter, coupled.chatter,
            coupled.stiffness / wall, feltStiffness(wall, coupling) / wall);
        for (const Felt* felt : {&coupled, &both}) {
          EXPECT_EQ(felt->violations, 0) << what;
          // With a coupling the hand gets no energy, not even the cost of one tick.
          EXPECT_LE(felt->to_hand, 1e-9) << what;
          EXPECT_LE(felt->beyond, 1e-9) << what;
          // Friction holds the device still. Without friction, a coupling below the limit rings
          // down, more slowly for a heavier device: an Excalibur, with a damping of 5 N s/m on 1.5
          // kg, still has 0.08 N of 8 N after a second.
          EXPECT_LE(felt->chatter, is_linear ? 0.1 : 1e-6) << what;
          if (shape == kFlat) {
            EXPECT_NEAR(felt->stiffness, feltStiffness(wall, coupling),
                        0.01 * feltStiffness(wall, coupling))
                << what;
          }
        }
      });
    }
  }
}

TEST(GuardedLoop, TheControllerKeepsTheEnergyOfATick) {
  for (const char* name : {"excalibur", "falcon", "touch", "omega_3"}) {
    for (const LoopModel& loop : loopsOf(name)) {
      const bool is_linear = loop.device.friction == 0.0;
      eachWall(loop, {2.0, 5.0, 10.0}, [&](const std::string& shape, double wall, bool taps) {
        const Felt plain = press(sceneOf(shape, wall), wall, loop, taps);
        const ScenePtr scene = sceneOf(shape, wall, "device: {passivity: {}}\n");
        const PassivityController guard(*guardsOf(scene->device(), loop, kTick).passivity);
        const double held = std::min(wall, guard.mostStiffness());  // [N/m]
        const Felt felt = press(scene, wall, loop, taps);
        const std::string what = std::string(name) + (is_linear ? " linear, " : ", ") +
                                 (shape == kFlat ? "flat, " : "ball, ") +
                                 (taps ? "tap, " : "press, ") + std::to_string(wall) + " N/m";
        std::printf(
            "%s: hand %.2g J, controlled %.2g J (cost %.2g J); chatter %.2g N, controlled %.2g N; "
            "felt %.3f of %.3f, added %.2g N\n",
            what.c_str(), plain.to_hand, felt.to_hand, felt.tick_cost, plain.chatter, felt.chatter,
            felt.stiffness / wall, held / wall, felt.most_added);
        EXPECT_EQ(felt.violations, 0) << what;
        EXPECT_LE(felt.beyond, PassivityObserver::kSeed) << what;
        // The settled stiffness is the wall's, or the controller's limit.
        EXPECT_NEAR(felt.stiffness, held, 0.06 * held) << what;
        EXPECT_LE(felt.chatter, 0.01) << what;
        if (is_linear) {
          EXPECT_GT(plain.beyond, 1e-4) << what;
        }
      });
    }
  }
}

TEST(GuardedLoop, BelowTheBudgetOfTheDeviceAloneNothingIsAdded) {
  // At 2 b / T, without friction or encoder, the device dissipates whatever the wall gives.
  LoopModel loop = loopOf("falcon");
  loop.device.encoder = 0.0;
  const double wall = 0.9 * 2.0 * loop.device.damping / kTick;
  const Felt with = press(sceneOf(kFlat, wall, "device: {passivity: {}}\n"), wall, loop);
  const Felt without = press(sceneOf(kFlat, wall), wall, loop);
  EXPECT_EQ(with.most_added, 0.0);
  EXPECT_EQ(with.stiffness, without.stiffness);
}

TEST(GuardedLoop, ASceneScaleActsOnTheWallAndNotOnTheCoupling) {
  // The same wall at the hand: in a world half as large, four times as stiff, with forces mapped
  // back at half size.
  const LoopModel loop = loopOf("omega_3");
  const std::string coupling = "coupling: {stiffness: 800 N/m, damping: 4 N.s/m}";
  const Felt plain = press(sceneOf(kFlat, 5000.0, "device: {" + coupling + "}\n"), 5000.0, loop);
  const Felt scaled =
      press(sceneOf(kFlat, 20000.0, "device: {scale: 0.5, force: 0.5, " + coupling + "}\n"), 5000.0,
            loop);
  EXPECT_NEAR(plain.stiffness, scaled.stiffness, 1e-6 * plain.stiffness);
  EXPECT_NEAR(plain.to_hand, scaled.to_hand, 1e-9);
}

TEST(GuardedLoop, ACheckpointKeepsTheGuards) {
  const ScenePtr scene =
      sceneOf(kFlat, 50000.0,
              "device: {passivity: {}, coupling: {stiffness: 2000 N/m, damping: 2 N.s/m}}\n");
  SessionSettings how;
  how.loop = loopOf("falcon");
  how.checkpoint_every = 100;
  Session one(scene, how);
  Session other(scene, how);
  const auto reading = [](int k) {
    return DeviceState{.time = k * kTick, .position = Vec3(0.0, 0.0, 2e-3 * std::sin(0.3 * k))};
  };
  for (int k = 0; k <= 300; ++k) (void)one.step(reading(k), DeviceFrame::kDevice);
  const SessionState state = one.checkpoint();
  ASSERT_TRUE(other.resume(state));
  for (int k = 300; k < 600; ++k) {
    const SessionTick b = other.step(reading(k), DeviceFrame::kDevice);
    if (k == 300) continue;
    const SessionTick a = one.step(reading(k), DeviceFrame::kDevice);
    ASSERT_EQ(a.force, b.force) << k;
    ASSERT_EQ(one.observer()->reserve(), other.observer()->reserve());
  }
  Session without(sceneOf(kFlat, 50000.0));
  EXPECT_FALSE(without.resume(state));
}

TEST(HandGuards, OfTheSettingsGoBeforeTheScenes) {
  // The scene's guards need a device, and none was named.
  SessionSettings how;
  how.passivity = PassivitySettings{.mass = 0.2};
  how.coupling = CouplingSettings{800.0, 4.0};
  const ScenePtr scene = sceneOf(kFlat, 1000.0, "device: {passivity: {}, coupling: {}}\n");
  EXPECT_NE(Session(scene, how).observer(), nullptr);
  EXPECT_THROW((void)Session(scene), Error);
  EXPECT_EQ(Session(sceneOf(kFlat, 1000.0)).observer(), nullptr);
}

TEST(HandGuards, SayWhatIsMissing) {
  const auto asked = [](const std::string& device) {
    return sceneOf(kFlat, 1000.0, "device: {" + device + "}\n")->device();
  };
  const LoopModel loop = loopOf("falcon", 1);
  EXPECT_FALSE(guardsOf(asked("scale: 2"), loop, kTick).passivity);
  EXPECT_FALSE(guardsOf(asked("scale: 2"), loop, kTick).coupling);
  EXPECT_THROW((void)guardsOf(asked("passivity: {}"), std::nullopt, kTick), Error);
  EXPECT_THROW((void)guardsOf(asked("coupling: {}"), std::nullopt, kTick), Error);
  const HandGuards own = guardsOf(
      asked("passivity: {mass: 300 g, damping: 2 N.s/m, encoder: 0.1, control: false}, coupling: "
            "{stiffness: 1 N/mm, damping: 3 N.s/m}"),
      std::nullopt, kTick);
  EXPECT_EQ(own.passivity->mass, 0.3);
  EXPECT_EQ(own.passivity->damping, 2.0);
  EXPECT_EQ(own.passivity->encoder, 1e-4);
  EXPECT_FALSE(own.passivity->controls);
  EXPECT_EQ(own.coupling->stiffness, 1000.0);
  EXPECT_EQ(own.coupling->damping, 3.0);
  const HandGuards designed =
      guardsOf(asked("passivity: {}, coupling: {for: any_scene}"), loop, kTick);
  EXPECT_EQ(designed.passivity->mass, loop.device.mass);
  EXPECT_EQ(designed.passivity->delay, 1);
  EXPECT_EQ(designed.coupling->stiffness, couplingForAnyScene(loop).stiffness);
}

}  // namespace
}  // namespace palpate::devices
