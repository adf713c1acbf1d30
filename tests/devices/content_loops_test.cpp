// A hand in the loop with what is not a wall: a puncture at its threshold, a lattice at the hand's resonance, a needle that is
// held by its shaft.

#include <gtest/gtest.h>

#include <cmath>
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
        // Friction of the device may take a part of what the hand gives, in either direction.
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
    // Its steepest slope, 2 pi f / w, is 0.8 of the budget of a wall.
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
    // Along a line of nodes, and across the waves.
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
  // 1e4 N/m for each meter of shaft, 20 mm of it in the tissue: 200 N/m, far below every budget.
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

}  // namespace
}  // namespace palpate::loops
