#pragma once
/// Simulates a hand in the loop: a simulated device and any renderer, in virtual time.

#include <cstdint>
#include <functional>

#include "palpate/devices/path.h"
#include "palpate/devices/stability.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate::loops {

struct LoopSetting {
  devices::LoopModel loop;
  devices::Path hand;  ///< [m, world] where the hand wants to go
  /// [-] Device force per renderer force: makes every wall stiffer by this factor
  double gain = 1.0;
  double window = 0.5;  ///< [s] at the end of the run; the part that is judged
  /// Noise of the sensor: each coordinate of a reading is one encoder step too high, too low, or
  /// right. Its seed is fixed.
  bool is_noisy = false;
  /// Called every kPollTicks ticks; an exception from it ends the run.
  std::function<void()> poll = {};
  static constexpr std::uint64_t kPollTicks = 256;
};

/// The result of a run.
struct LoopOutcome {
  /// [N] Largest peak to peak value of a component of the force, over the window
  double chatter = 0.0;
  double before = 0.0;  ///< [N] the same over an equal time before the window
  double frequency =
      0.0;             ///< [Hz] of the force about its mean, for the component that oscillates most
  double mean = 0.0;   ///< [N] length of the mean force over the window
  double depth = 0.0;  ///< [m] mean distance of the device from the first contact, over the window
  double to_hand = 0.0;    ///< [J] largest energy that reached the hand
  double by_motors = 0.0;  ///< [J] largest energy that the motors gave
  double tick_cost =
      0.0;  ///< [J] K (v T)^2 + F v T, with `wall` for K and the largest speed and force
  double largest_step = 0.0;  ///< [N] of the force from tick to tick
  double tick_ns = 0.0;       ///< [ns] of the renderer, median over the ticks in contact
  bool touches = false;       ///< there was a force in the window
  bool is_lost = false;       ///< something was not finite, or went 1 m away

  /// [N] Whether there is no oscillation: one that dies out, or that a hand hardly feels, does not
  /// count.
  [[nodiscard]] bool isQuiet(double least = 0.01) const noexcept {
    return !is_lost && (chatter < least || chatter < 0.7 * before);
  }
};

/// Runs `renderer`, after a reset, until the hand's path ends. `wall` [N/m]: the renderer's largest
/// stiffness.
/// @throws Error as SimulatedDevice.
[[nodiscard]] LoopOutcome runLoop(HapticRenderer& renderer, const LoopSetting& setting,
                                  double wall);

/// [m] How far behind the surface the hand's target must be so that it presses with `force` [N] on
/// a wall of `stiffness` [N/m], through its own stiffness and that of its grip.
[[nodiscard]] double depthOfForce(const devices::LoopModel& loop, double stiffness, double force);

/// How a hand moves to the point that it holds.
enum class Motion : std::uint8_t {
  kPress,  ///< slowly, at 20 mm/s
  kTap,    ///< at 0.5 m/s
  kDrag,   ///< slowly, then 10 mm along the surface at 0.5 m/s and back
};

/// The path of a hand that starts 2 mm outside of `at`, goes `depth` [m] inside and stays there for
/// `hold` [s]. `out` [-] is a unit vector.
[[nodiscard]] devices::Path pressOn(const Vec3& at, const Vec3& out, double depth, double hold,
                                    Motion motion = Motion::kPress);

/// The largest gain between `low` and `high` at which `is_stable` holds, to 1 %; 0 if it does not
/// hold at `low`.
[[nodiscard]] double largestGain(const std::function<bool(double)>& is_stable, double low,
                                 double high);

}  // namespace palpate::loops
