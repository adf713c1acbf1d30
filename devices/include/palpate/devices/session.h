#pragma once
/// Session: one hand in one scene, from the device's reading to the force that it gets.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "palpate/devices/clutch.h"
#include "palpate/devices/scene_budget.h"
#include "palpate/devices/servo_loop.h"
#include "palpate/devices/velocity.h"
#include "palpate/render/contents.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate::devices {

class Recorder;

/// From `time` on the content of `region` feels as `change` says; what was changed of it before is taken back.
struct ContentEvent {
  double time = 0.0;  ///< [s] of the device
  RegionId region = kOutside;
  ContentChange change = {};
};

struct SessionSettings {
  RendererSettings renderer = {};
  VelocitySettings velocity = {};
  ServoSettings servo = {};
  int clutch_button =
      0;  ///< bit of DeviceState::buttons, 0 to 31, that holds the clutch, where the scene allows one
  std::vector<ContentEvent> changes = {};  ///< by time
  /// [ticks] Before each tick whose number is a multiple of this, but 0, Session::checkpoint() is taken; 0: never. Two sessions
  /// feel the same bit for bit only if theirs is the same: see HapticRenderer::checkpoint().
  std::uint64_t checkpoint_every = 0;
  /// The device and the hand that the scene is for: Session::overBudget() then warns. Its period
  /// and its velocity are the session's own, whatever is here.
  std::optional<LoopModel> loop = {};
};

/// All that one tick of a session leaves for the next. A value of fixed size, about 30 kB, for the build that made it: stored, it
/// means nothing to another.
struct SessionState {
  RendererState renderer;
  VelocityTracker tracker;
  Clutch clutch;
  std::uint64_t ticks = 0;        ///< that were made
  std::uint64_t next_change = 0;  ///< of SessionSettings::changes, the first that has not come yet
  double last_time = 0.0;         ///< [s]
  bool has_begun = false;
};
static_assert(std::is_trivially_copyable_v<SessionState>);

/// What one tick took in and what came out.
struct SessionTick {
  std::uint64_t number = 0;  ///< from 0
  DeviceState reading;       ///< as it came
  /// [s] since the last reading: the servo's period at the first, 0 where the time did not rise or is not a number
  double dt = 0.0;
  HipState hip;                   ///< [world] what the renderer got
  TickResult result;              ///< [world] what it answered
  Vec3 unlimited{0.0, 0.0, 0.0};  ///< [N, world] its force before the limits
  Vec3 force{0.0, 0.0, 0.0};      ///< [N] in the device's frame: for the device
  std::int64_t renderer_ns = 0;   ///< [ns] of the renderer's update alone
  bool is_held = false;           ///< the clutch is
  bool is_checkpoint = false;     ///< Session::checkpoint() is what was before this tick
};

/// Owns the renderer, the velocity tracker, the clutch and all that they keep between ticks; the scene is shared and const.
/// Construction may throw and allocate; step() never allocates, locks, throws or blocks. One thread at a time.
class Session {
 public:
  /// Called after each tick of run(), in the servo thread: it must not allocate, lock, throw or block.
  using Listener = std::function<void(const SessionTick&, const HapticRenderer&)>;

  /// @throws Error (kInput) as makeRenderer(); (kUsage) for velocity settings, a button or changes
  /// that cannot be, and as sceneBudget() for a loop.
  explicit Session(ScenePtr scene, SessionSettings settings = {});

  /// One tick: device -> world by the scene's mapping (or as it is, for DeviceFrame::kWorld), velocity, clutch, renderer, and
  /// the force back. A reading that is not finite gives zero force.
  [[nodiscard]] SessionTick step(const DeviceState& reading, DeviceFrame frame) noexcept;

  /// step() for each reading of `device`, by runServo(), until that ends or `stop` is set. @throws Error as runServo().
  [[nodiscard]] ServoReport run(Device& device, const std::atomic<bool>& stop,
                                const Listener& listener = {});

  /// The same, each tick into `recorder`, once its force was written. @throws Error as runServo().
  [[nodiscard]] ServoReport run(Device& device, const std::atomic<bool>& stop, Recorder& recorder);

  /// What was before the last tick whose SessionTick::is_checkpoint is set. A session of the same scene and settings that resume()s
  /// from it feels bit for bit what this one felt from there.
  [[nodiscard]] const SessionState& checkpoint() const noexcept { return checkpoint_; }
  /// Goes on from a checkpoint of a session with the same scene and settings; contents that changed before it are changed. False,
  /// and nothing is done, if this session has made a tick, or if it cannot be a state of it.
  [[nodiscard]] bool resume(const SessionState& state) noexcept;
  /// The number of the next tick.
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }

  /// A warning of set-up: what of the scene is stiffer than SessionSettings::loop can hold. Empty
  /// without a loop. What is felt does not change for it.
  [[nodiscard]] const std::vector<BudgetItem>& overBudget() const noexcept { return over_budget_; }

  [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
  [[nodiscard]] HapticRenderer& renderer() noexcept { return *renderer_; }
  [[nodiscard]] const HapticRenderer& renderer() const noexcept { return *renderer_; }

 private:
  ScenePtr scene_;
  SessionSettings settings_;
  std::unique_ptr<HapticRenderer> renderer_;
  VelocityTracker tracker_;
  Clutch clutch_;
  /// Changes the contents whose time has come.
  void changeUntil(double time) noexcept;
  void saveCheckpoint() noexcept;

  std::uint64_t ticks_ = 0;
  std::size_t next_change_ = 0;
  bool has_begun_ = false;
  double last_time_ = 0.0;
  SessionState checkpoint_;
  std::vector<BudgetItem> over_budget_;
};

}  // namespace palpate::devices
