// A hand in the loop with contents and ports: a puncture at its threshold, a lattice at the hand's
// resonance, a needle held by its shaft.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "palpate/scene/scene_file.h"
#include "support/loops/loop_limit.h"
#include "support/loops/loop_run.h"
#include "support/rivals/rival_renderer.h"

namespace palpate::loops {
namespace {

const std::vector<std::string>& fourDevices() {
  static const std::vector<std::string> all = {"excalibur", "falcon", "touch", "omega_3"};
  return all;
}

ScenePtr sceneOf(const std::string& text) {
  return compile(parseScene("palpate: 1\nlength: mm\n" + text, "loop.yaml"));
}

devices::LoopModel loopOf(const std::string& device, int delay = 0) {
  return loopModelOf({"", "constraint", device, "relaxed", 1000.0, delay});
}

TEST(ContentLoops, APunctureAtItsThresholdOpensOnceOrNotAtAll) {
  for (const std::string& device : fourDevices()) {
    for (const int delay : {0, 1}) {
      const devices::LoopModel loop = loopOf(device, delay);
      const double stiffness = 0.8 * devices::budgetOf(loop).stiffness();
      const auto renderer = makeLoopRenderer(
          "constraint",
          sceneOf("materials:\n  wall: {stiffness: " + std::to_string(stiffness) +
                  " N/m}\nlayers:\n  - {name: block, inside: {box: {center: [0, 0, -50], size: "
                  "[100, 100, 100]}}, wall: wall}\nports:\n  - {name: skin, between: [outside, "
                  "block], opens_at: 2 N}\n"));
      for (const double share : {0.6, 1.6}) {
        // The device's friction may take a part of the hand's force, in either direction.
        const double force = share * 2.0 + (share > 1.0 ? 1.0 : -1.0) * 0.3 * loop.device.friction;
        const Vec3 up(0.0, 0.0, 1.0);
        const LoopSetting setting{
            .loop = loop,
            .hand = pressOn(Vec3(0.0), up, depthOfForce(loop, stiffness, force), 1.3)};
        const LoopOutcome out = runLoop(*renderer, setting, stiffness);
        EXPECT_TRUE(out.isQuiet()) << device << ", " << force << " N: " << out.chatter << " N";
        EXPECT_EQ(out.touches, share < 1.0) << device << ", " << force << " N";
      }
    }
  }
}

/// -f sin(2 pi x / w) along each axis.
class Lattice final : public rivals::RivalRenderer {
 public:
  Lattice(ScenePtr scene, double force, double wavelength)
      : RivalRenderer(std::move(scene)), force_(force), wavelength_(wavelength) {}

 private:
  void forget() noexcept override {}

  [[nodiscard]] TickResult step(const HipState& hip) noexcept override {
    TickResult out = untouched(hip);
    for (int axis = 0; axis < 3; ++axis) {
      out.force[axis] =
          -force_ * std::sin(2.0 * std::numbers::pi * hip.position[axis] / wavelength_);
    }
    return out;
  }

  double force_;
  double wavelength_;
};

TEST(ContentLoops, ALatticeAtTheHandsResonanceSwingsAsItsClosedFormDoes) {
  constexpr double kWave = 5e-3;  // [m]
  for (const std::string& device : fourDevices()) {
    const devices::LoopModel loop = loopOf(device);
    // The lattice's steepest slope, 2 pi f / w, is 0.8 of the budget of a wall.
    const double slope = 0.8 * devices::budgetOf(loop).stiffness();
    const double force = std::min(1.0, slope * kWave / (2.0 * std::numbers::pi));
    const ScenePtr scene = sceneOf(
        "materials:\n  wall: {stiffness: 1000 N/m}\n  grid: {stiffness: 1e5 N/m, lattice: "
        "{force: " +
        std::to_string(force) +
        " N, wavelength: [5, 5, 5]}}\nlayers:\n  - {name: tank, inside: {box: {center: [0, 0, 0], "
        "size: "
        "[200, 200, 200]}}, content: grid, wall: wall}\nstart: {region: tank}\n");
    const auto ours = makeLoopRenderer("constraint", scene);
    Lattice truth(scene, std::stod(std::to_string(force)), kWave);
    const double mass = loop.device.mass + loop.hand->mass;
    const double resonance =
        std::sqrt(loop.hand->stiffness / mass) / (2.0 * std::numbers::pi);  // [Hz]
    const double speed = resonance * kWave;
    // The hand moves along a line of nodes, and across the waves.
    const LoopSetting setting{.loop = loop,
                              .hand = {{0.0, Vec3(0.0)}, {2.0, Vec3(2.0 * speed, 0.0, 0.0)}}};
    const LoopOutcome felt = runLoop(*ours, setting, slope);
    const LoopOutcome closed = runLoop(truth, setting, slope);
    std::printf("%s, %.3g N at %.3g Hz: swings %.4g N, closed form %.4g N\n", device.c_str(), force,
                resonance, felt.chatter, closed.chatter);
    EXPECT_GT(closed.chatter, 0.0);
    EXPECT_LE(felt.chatter, 1.1 * closed.chatter + 1e-3) << device;
    EXPECT_NEAR(felt.mean, closed.mean, 0.01 * force) << device;
  }
}

TEST(ContentLoops, ANeedleHeldByItsShaftComesToRest) {
  // 1e4 N/m for each meter of shaft, with 20 mm of it in the tissue: 200 N/m, far below every
  // budget.
  const auto renderer = makeLoopRenderer(
      "constraint",
      sceneOf("materials:\n  skin: {stiffness: 400 N/m}\n  tissue: {stiffness: 400 N/m, cutting: "
              "0.3 N, shaft: {stiffness: 1e4 N/m^2, in: {static: 20 N/m, kinetic: 15 N/m}}}\n"
              "layers:\n  - {name: tissue, inside: {box: {center: [0, 0, -50], size: [100, 100, "
              "100]}}, content: tissue, wall: skin}\nports:\n  - {name: skin, between: [outside, "
              "tissue], opens_at: 0.5 N}\n"));
  for (const std::string& device : fourDevices()) {
    for (const int delay : {0, 1}) {
      const devices::LoopModel loop = loopOf(device, delay);
      const LoopSetting setting{.loop = loop,
                                .hand = pressOn(Vec3(0.0), Vec3(0.0, 0.0, 1.0), 25e-3, 1.5)};
      const LoopOutcome out = runLoop(*renderer, setting, 400.0);
      EXPECT_TRUE(out.isQuiet()) << device << ": " << out.chatter << " N, before " << out.before;
      EXPECT_TRUE(out.touches) << device;
    }
  }
}

/// A hand on a prescribed path makes one round a second; the contents may change on the way.
struct Round {
  std::string name;
  std::string text;     ///< of the scene
  Vec3 center{0.0};     ///< [m]
  Vec3 radii{0.0};      ///< [m] along x and z; it begins at center + radii.z along z
  double steepest = 0;  ///< [N/m] of all forces that depend on the position
  double drag = 0;      ///< [N s/m] of all forces that depend on the speed
  /// The changes at a quarter and at three quarters of the way.
  ContentChange first = {};
  ContentChange second = {};
  /// [J] The energy that change `index` adds with the hand at `p` [m].
  std::function<double(int index, const Vec3& p)> given = {};
};

std::vector<Round> rounds() {
  const std::string block =
      "layers:\n  - {name: block, inside: {box: {center: [0, 0, -25], size: [100, 100, 50]}}, "
      "wall: wall";
  const std::string hole =
      "ports:\n  - {name: hole, between: [outside, block], where: {cylinder: {center: [0, 0, 0], "
      "axis: [0, 0, 1], radius: 5, height: 20}}";
  const std::string plain = "materials:\n  wall: {stiffness: 1000 N/m}\n";
  const std::string room =
      "layers:\n  - {name: block, inside: {box: {center: [0, 0, 0], size: [100, 100, 100]}}, wall: "
      "wall, content: content}\nstart: {region: block}\n";
  constexpr double kWave = 5e-3;
  std::vector<Round> all;
  // The hand goes in by the port, over its rim inside the block, and out through it again; then in
  // the opposite direction.
  for (const double side : {1.0, -1.0}) {
    all.push_back({side > 0.0 ? "round a rim" : "round a rim, the other way",
                   plain + block + "}\n" + hole + "}\n", Vec3(5e-3, 0.0, 0.0),
                   Vec3(side * 2e-3, 0.0, 2e-3), 1000.0});
  }
  all.push_back({"across a rim, pressed", plain + block + "}\n" + hole + "}\n",
                 Vec3(4e-3, 0.0, 0.5e-3), Vec3(3e-3, 0.0, 1.5e-3), 1000.0});
  all.push_back({"by a port that opens at what is pressed",
                 plain + block + "}\n" + hole + ", opens_at: 1 N}\n", Vec3(0.0),
                 Vec3(2e-3, 0.0, 2e-3), 1000.0});
  all.push_back({"by a port that gives way once and for all",
                 plain + block + "}\n" + hole +
                     ", opens_at: 1 N, hole: {radius: 1, reopens_at: 0.5 N}, rearm: 0.5}\n",
                 Vec3(0.0), Vec3(-2e-3, 0.0, 2e-3), 1000.0});
  Round drag{"viscosity changes", plain + "  content: {viscosity: 2 N.s/m}\n" + room, Vec3(0.0),
             Vec3(5e-3, 0.0, 5e-3)};
  drag.drag = 8.0;
  drag.first.viscosity = 8.0;
  drag.second.viscosity = 0.5;
  all.push_back(drag);
  Round lattice{
      "a lattice changes",
      plain + "  content: {stiffness: 1e5 N/m, lattice: {force: 1 N, wavelength: [5, 5, 5]}}\n" +
          room,
      Vec3(0.0), Vec3(7e-3, 0.0, 6e-3)};
  lattice.steepest = 2.0 * std::numbers::pi / kWave;
  lattice.first.lattice_force = 0.4;
  lattice.second.lattice_force = 1.0;
  lattice.given = [](int index, const Vec3& p) {
    double cosines = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      cosines += std::cos(2.0 * std::numbers::pi * p[axis] / kWave);
    }
    const double more = index == 0 ? -0.6 : 0.6;  // [N]
    return -more * kWave / (2.0 * std::numbers::pi) * cosines;
  };
  all.push_back(lattice);
  return all;
}

TEST(ContentLoops, WhatADictatedHandGetsByPortsAndContentsFallsWithThePeriod) {
  // A force that is held for a tick gives at most K |dx|^2 / 2 more energy than the continuous one;
  // drag never gives any. In the limit of short ticks, only the energy that a change of the content
  // adds is left.
  for (const Round& round : rounds()) {
    const ScenePtr scene = sceneOf(round.text);
    const auto renderer = makeLoopRenderer("constraint", scene);
    std::vector<double> got;
    std::vector<double> most;
    for (const double period : {1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
      renderer->reset();
      double work = 0.0;
      double squares = 0.0;
      double given = 0.0;
      Vec3 before(0.0);
      Vec3 force(0.0);
      const int ticks = static_cast<int>(std::lround(1.0 / period));
      // Restore what was changed in the last round.
      for (RegionId region = 0; region < scene->regions().size(); ++region) {
        (void)renderer->setContent(region, {});
      }
      for (int k = 0; k <= ticks; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / ticks;
        const Vec3 p = round.center +
                       Vec3(round.radii.x * std::sin(angle), 0.0, round.radii.z * std::cos(angle));
        Vec3 velocity(0.0);
        if (k > 0) {
          work += glm::dot(force, p - before);
          squares += glm::dot(p - before, p - before);
          velocity = (p - before) / period;
        }
        for (const int index : {0, 1}) {
          const ContentChange& change = index == 0 ? round.first : round.second;
          if (k != (2 * index + 1) * ticks / 4) continue;
          if (!change.viscosity && !change.lattice_force) continue;
          ASSERT_TRUE(renderer->setContent(scene->regionNamed("block"), change)) << round.name;
          if (round.given) given += round.given(index, p);
        }
        before = p;
        force = renderer->update({p, velocity, period}).force;
      }
      // The renderer counts the energy that a change adds, but not the energy that another one
      // removes.
      const double sources = round.given ? given : renderer->sourceWork();
      got.push_back(work - sources);
      most.push_back(0.5 * (1.5 * round.steepest + round.drag / period) * squares);
      EXPECT_LE(got.back(), most.back() + 1e-9) << round.name << " at " << period << " s";
    }
    std::printf("%s: %.3g J at 1 kHz, %.3g J at 8 kHz, sampling may give %.2g and %.2g J\n",
                round.name.c_str(), got.front(), got.back(), most.front(), most.back());
    // Where friction or a fall takes energy, sampling must not give it back.
    for (std::size_t i = 0; i < got.size(); ++i) {
      EXPECT_LE(got[i] - got.back(), most[i] + 1e-9) << round.name << ", run " << i;
    }
    EXPECT_LT(got.back(), 0.2 * std::max(got.front(), 0.0) + 1e-8) << round.name;
  }
}

}  // namespace
}  // namespace palpate::loops
