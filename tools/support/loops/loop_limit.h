#pragma once
/// Finds, by running the loop, how stiff a wall one renderer can give one device.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "palpate/core/progress.h"
#include "support/loops/hard_scene.h"
#include "support/loops/loop_run.h"

namespace palpate::loops {

/// One case to run: a row of the table.
struct LoopCase {
  std::string scene;
  std::string renderer;
  std::string device;
  std::string hand = "relaxed";
  double rate = 1000.0;  ///< [Hz]
  int delay = 0;         ///< [samples]
};

/// The result; the hand presses with about 1 N, whatever the stiffness.
struct LoopLimit {
  static constexpr double kLeast = 400.0;  ///< [N/m] the softest wall that is tried
  static constexpr double kMost = 1e5;     ///< [N/m] and the stiffest

  LoopCase what;
  double linear = 0.0;  ///< [N/m] exact limit of the sampled loop on a flat wall
  double budget = 0.0;  ///< [N/m] StabilityBudget::stiffness()
  /// [N/m] The stiffest wall on which the hand comes to rest, to 1 %; 0: not even on the softest;
  /// kMost: on all of them.
  double found = 0.0;
  double cycle = 0.0;      ///< [N] peak to peak of the force, at 15 % above `found`
  double frequency = 0.0;  ///< [Hz] of this oscillation
  // On a wall as stiff as the budget, or `found` if that is less, clamped to kLeast and kMost:
  double to_hand = 0.0;       ///< [J] largest energy that reached the hand
  double largest_step = 0.0;  ///< [N] of the force from tick to tick
  double tick_ns = 0.0;       ///< [ns] of the renderer, median
  bool holds = false;         ///< the wall was felt at the end
};

/// The names of the renderers: ours, the source paper's, and those of support/rivals.
[[nodiscard]] const std::vector<std::string>& loopRenderers();
/// Whether the renderer can render the scene at all.
[[nodiscard]] bool canRender(const std::string& renderer, const HardScene& scene);
/// @throws Error (kInput) if it cannot.
[[nodiscard]] std::unique_ptr<HapticRenderer> makeLoopRenderer(const std::string& renderer,
                                                               const ScenePtr& scene);

/// @throws Error (kUsage) for an unknown device or hand.
[[nodiscard]] devices::LoopModel loopModelOf(const LoopCase& what);
/// At most 24 runs of less than 3 s of device time each. `poll` as in LoopSetting.
[[nodiscard]] LoopLimit findLimit(const LoopCase& what, const HardScene& scene,
                                  HapticRenderer& renderer, const std::function<void()>& poll = {});

}  // namespace palpate::loops
