#pragma once
/// Session: one hand in one scene, from the device's reading to the force that it gets.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/devices/device.h"
#include "palpate/devices/passivity.h"
#include "palpate/devices/scene_budget.h"
#include "palpate/devices/velocity.h"
#include "palpate/devices/virtual_coupling.h"
#include "palpate/export.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate::devices {

/// What the clutch makes of one reading.
struct Clutched {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world] where the probe is
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s, world] of the probe, as drag and damping are to feel it
  double share = 1.0;            ///< [-] of the force that the hand gets
};

/// A value type, real-time safe. The reading with which the clutch is engaged, and that with which
/// it is let go, have the position, the velocity and the share of the force that they would have
/// had without; what changes begins with the next one. From there on the force fades to nothing, or
/// comes back, and the velocity goes from what it was to zero, or to the hand's, as 3 s^2 - 2 s^3
/// over kFade: a drag that stopped at once would be a kick.
class Clutch {
 public:
  static constexpr double kFade = 0.05;  ///< [s]

  /// `position` [m, world] and `velocity` [m/s, world] of the reading by the mapping alone; `dt`
  /// [s] since the last reading, of which nothing below 0 counts.
  [[nodiscard]] Clutched step(const Vec3& position, const Vec3& velocity, bool is_held,
                              double dt) noexcept {
    const double change = dt > 0.0 ? std::min(1.0, dt / kFade) : 0.0;
    fade_ = is_held_ ? std::max(0.0, fade_ - change) : std::min(1.0, fade_ + change);
    turned_ = std::min(1.0, turned_ + change);
    const Vec3 to = is_held_ ? Vec3(0.0) : velocity;
    const Clutched out{is_held_ ? held_ : position + shift_,
                       turned_ < 1.0 ? from_ + smooth(turned_) * (to - from_) : to, smooth(fade_)};
    if (is_held != is_held_) {
      is_held_ = is_held;
      if (is_held) held_ = out.position;
      if (!is_held) shift_ = held_ - position;
      from_ = out.velocity;
      turned_ = 0.0;
    }
    return out;
  }

 private:
  [[nodiscard]] static double smooth(double s) noexcept { return s * s * (3.0 - 2.0 * s); }

  bool is_held_ = false;
  double fade_ = 1.0;          ///< [-] of the force, before it is smoothed
  double turned_ = 1.0;        ///< [-] how far the velocity got since the clutch turned
  Vec3 from_{0.0, 0.0, 0.0};   ///< [m/s, world] the velocity with which it turned
  Vec3 shift_{0.0, 0.0, 0.0};  ///< [m, world] that all clutching so far has added
  Vec3 held_{0.0, 0.0, 0.0};   ///< [m, world]
};

class Recorder;

/// From `time` on the content of `region` feels as `change` says; what was changed of it before is
/// taken back.
struct ContentEvent {
  double time = 0.0;  ///< [s] of the device
  RegionId region = kOutside;
  ContentChange change = {};
};

struct SessionSettings {
  RendererSettings renderer = {};
  VelocitySettings velocity = {};
  ServoSettings servo = {};
  int clutch_button = 0;  ///< bit of DeviceState::buttons, 0 to 31, that holds the clutch, where
                          ///< the scene allows one
  std::vector<ContentEvent> changes = {};  ///< by time
  /// Both are at the hand, in the device's frame. Not given: as the scene's `device` asks for, with
  /// what it does not say from `loop` (hand_guards.h); off if it does not.
  std::optional<PassivitySettings> passivity = {};
  std::optional<CouplingSettings> coupling = {};
  /// [ticks] Before each tick whose number is a multiple of this, but 0, Session::checkpoint() is
  /// taken; 0: never. Two sessions feel the same bit for bit only if theirs is the same: see
  /// HapticRenderer::checkpoint().
  std::uint64_t checkpoint_every = 0;
  /// The device and the hand that the scene is for: Session::overBudget() then warns. Its period
  /// and its velocity are the session's own, whatever is here.
  std::optional<LoopModel> loop = {};
};

/// All that one tick of a session leaves for the next. A value of fixed size, about 30 kB, for the
/// build that made it: stored, it means nothing to another.
struct SessionState {
  RendererState renderer;
  VelocityTracker tracker;
  Clutch clutch;
  std::optional<VirtualCoupling> coupling;
  std::optional<PassivityController> passivity;
  double source_work = 0.0;       ///< [J] of the renderer, up to the last tick
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
  /// [s] since the last reading: the servo's period at the first, 0 where the time did not rise or
  /// is not a number
  double dt = 0.0;
  HipState hip;                   ///< [world] what the renderer got; with a coupling the tool
  TickResult result;              ///< [world] what it answered
  Vec3 unlimited{0.0, 0.0, 0.0};  ///< [N, world] its force before the limits
  Vec3 force{0.0, 0.0, 0.0};      ///< [N] in the device's frame: for the device
  Vec3 added{0.0, 0.0, 0.0};      ///< [N] of it by the passivity controller
  std::int64_t renderer_ns = 0;   ///< [ns] of the renderer's update alone
  bool is_held = false;           ///< the clutch is
  bool is_checkpoint = false;     ///< Session::checkpoint() is what was before this tick
};

/// What another thread may see of a session while it runs.
struct SessionView {
  std::uint64_t number = 0;    ///< of the tick
  double time = 0.0;           ///< [s] of the device
  Vec3 hip{0.0, 0.0, 0.0};     ///< [m, world]
  Vec3 proxy{0.0, 0.0, 0.0};   ///< [m, world]
  Vec3 force{0.0, 0.0, 0.0};   ///< [N, world] after the limits
  RegionId region = kOutside;  ///< of the proxy
  std::uint32_t buttons = 0;
  bool is_held = false;  ///< the clutch is
};

/// Owns the renderer, the velocity tracker, the clutch, the guards of stability and all that they
/// keep between ticks; the scene is shared and const. Construction may throw and allocate; step()
/// never allocates, locks, throws or blocks. One thread at a time.
class PALPATE_EXPORT Session {
 public:
  /// Called after each tick of run(), in the servo thread: it must not allocate, lock, throw or
  /// block.
  using Listener = std::function<void(const SessionTick&, const HapticRenderer&)>;

  /// @throws Error (kInput) as makeRenderer(); (kUsage) for velocity settings, a servo loop, limits
  /// of the force, a button, changes, passivity or a coupling that cannot be, and as sceneBudget()
  /// for a loop.
  explicit Session(ScenePtr scene, SessionSettings settings = {});
  ~Session();
  Session(Session&& other) noexcept;
  Session& operator=(Session&& other) noexcept;

  /// One tick: device -> world by the scene's mapping (or as it is, for DeviceFrame::kWorld),
  /// velocity, clutch, coupling, renderer, and the force back through the coupling and the
  /// passivity controller. A reading that is not finite gives zero force.
  [[nodiscard]] SessionTick step(const DeviceState& reading, DeviceFrame frame) noexcept;

  /// step() for each reading of `device`, by runServo(), until that ends or `stop` is set. @throws
  /// Error as runServo().
  [[nodiscard]] ServoReport run(Device& device, const std::atomic<bool>& stop,
                                const Listener& listener = {});

  /// The same, each tick into `recorder`, once its force was written. @throws Error as runServo().
  [[nodiscard]] ServoReport run(Device& device, const std::atomic<bool>& stop, Recorder& recorder);

  /// What was before the last tick whose SessionTick::is_checkpoint is set. A session of the same
  /// scene and settings that resume()s from it feels bit for bit what this one felt from there.
  [[nodiscard]] const SessionState& checkpoint() const noexcept { return checkpoint_; }
  /// Goes on from a checkpoint of a session with the same scene and settings; contents that changed
  /// before it are changed. False, and nothing is done, if this session has made a tick, or if it
  /// cannot be a state of it.
  [[nodiscard]] bool resume(const SessionState& state) noexcept;
  /// The number of the next tick.
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }

  /// The energy that the loop gave to the hand; null unless SessionSettings::passivity is given.
  [[nodiscard]] const PassivityObserver* observer() const noexcept {
    return passivity_ ? &passivity_->observer() : nullptr;
  }

  /// From any thread: the hand goes on in another scene, with a renderer that is made here and now.
  /// While the servo thread runs, what was felt goes with it by names (carryState()), up to the
  /// last region that the probe came into. From one tick to the next the scene is another; the
  /// force begins at zero and comes back within kSwapFade. A scene that was offered and not yet
  /// taken is forgotten. Changes of contents asked for by time do not hold in it, and a record does
  /// not know of it. Passivity and the coupling go on as they were asked for at first. Waits for
  /// the servo thread, a second at most. One thread at a time. @throws Error (kInput) as
  /// makeRenderer().
  void offer(ScenePtr scene, const RendererSettings& settings);
  /// From any thread: the last tick. None before the first.
  [[nodiscard]] std::optional<SessionView> view() const noexcept;
  static constexpr double kSwapFade = 0.1;  ///< [s]
  /// A warning of set-up: what of the scene is stiffer than SessionSettings::loop can hold. Empty
  /// without a loop. What is felt does not change for it.
  [[nodiscard]] const std::vector<BudgetItem>& overBudget() const noexcept { return over_budget_; }

  [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
  [[nodiscard]] HapticRenderer& renderer() noexcept { return *renderer_; }
  [[nodiscard]] const HapticRenderer& renderer() const noexcept { return *renderer_; }

 private:
  struct Shared;

  /// Takes the scene that was offered, if one was.
  void swapScene() noexcept;

  std::unique_ptr<Shared> shared_;
  ScenePtr scene_;
  SessionSettings settings_;
  std::unique_ptr<HapticRenderer> renderer_;
  VelocityTracker tracker_;
  Clutch clutch_;
  std::optional<VirtualCoupling> coupling_;
  std::optional<PassivityController> passivity_;
  double source_work_ = 0.0;  ///< [J] of the renderer, up to the last tick

  struct Felt {
    Vec3 force{0.0, 0.0, 0.0};  ///< [N, world]
    double stiffness = 0.0;     ///< [N/m] of the wall, at the hand; 0: not known
  };
  /// The renderer's answer for the probe at `probe`, through the coupling if there is one, and
  /// before the clutch.
  [[nodiscard]] Felt feel(const Clutched& probe, DeviceFrame frame, SessionTick& tick) noexcept;
  /// Changes the contents whose time has come.
  void changeUntil(double time) noexcept;
  void saveCheckpoint() noexcept;

  std::uint64_t ticks_ = 0;
  std::size_t next_change_ = 0;
  bool has_begun_ = false;
  double swap_fade_ = 1.0;  ///< [-] of the force since the scene was swapped
  double last_time_ = 0.0;
  SessionState checkpoint_;
  std::vector<BudgetItem> over_budget_;
};

}  // namespace palpate::devices
