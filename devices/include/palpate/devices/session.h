#pragma once
/// Session: one hand in one scene, from the device's reading to the force that it gets.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/devices/device.h"
#include "palpate/devices/passivity.h"
#include "palpate/devices/scene_budget.h"
#include "palpate/devices/velocity.h"
#include "palpate/devices/virtual_coupling.h"
#include "palpate/export.h"
#include "palpate/render/force_guard.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate::devices {

/// The clutch's result for one reading.
struct Clutched {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world] where the probe is
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s, world] of the probe, for drag and damping
  double share = 1.0;            ///< [-] of the force that the hand gets
};

/// A value type, real-time safe. The reading at which the clutch is engaged, and the one at which
/// it is released, still have the position, velocity and share of the force that they would have
/// without the clutch; changes begin with the next reading. From there on the force fades to zero,
/// or returns, and the velocity goes from its value to zero, or to the hand's, as 3 s^2 - 2 s^3
/// over kFade: a drag that stopped at once would be a kick.
class Clutch {
 public:
  static constexpr double kFade = 0.05;  ///< [s]

  /// `position` [m, world] and `velocity` [m/s, world] are those of the reading by the mapping
  /// alone; `dt` [s] since the last reading, where a negative one counts as 0.
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
  double fade_ = 1.0;    ///< [-] share of the force, before it is smoothed
  double turned_ = 1.0;  ///< [-] progress of the velocity's change since the clutch was switched
  Vec3 from_{0.0, 0.0, 0.0};   ///< [m/s, world] the velocity when it was switched
  Vec3 shift_{0.0, 0.0, 0.0};  ///< [m, world] the sum of all displacements by clutching
  Vec3 held_{0.0, 0.0, 0.0};   ///< [m, world]
};

class Recorder;

/// From `time` on the content of `region` feels as `change` says; earlier changes of it are taken
/// back.
struct ContentEvent {
  double time = 0.0;           ///< [s] of the device's clock
  RegionId region = kOutside;  ///< region whose content changes
  ContentChange change = {};   ///< replaces all earlier changes of `region`
};

/// The settings of a session, which its constructor checks.
struct SessionSettings {
  RendererSettings renderer = {};  ///< renderer, and limits of the force
  VelocitySettings velocity = {};  ///< estimator of the hand's velocity
  ServoSettings servo = {};        ///< its `rate` also gives SessionTick::dt of the first tick
  /// bit of DeviceState::buttons, 0 to 31, that engages the clutch, if the scene allows one
  int clutch_button = 0;
  std::vector<ContentEvent> changes = {};  ///< in the order of time
  /// Both act at the hand, in the device's frame. No value: as the scene's `device` asks for,
  /// completed with numbers from `loop` (hand_guards.h); off if the scene does not ask for it.
  std::optional<PassivitySettings> passivity = {};
  /// Spring and damper between the hand and the tool.
  std::optional<CouplingSettings> coupling = {};
  /// [ticks] Session::checkpoint() is taken before each tick whose number is a multiple of this,
  /// except tick 0; 0: never. Two sessions feel the same bit for bit only if both have the same
  /// value here: see HapticRenderer::checkpoint().
  std::uint64_t checkpoint_every = 0;
  /// The device and the hand for which the scene is meant: Session::overBudget() then warns. Its
  /// period and velocity are replaced by the session's own.
  std::optional<LoopModel> loop = {};
};

/// All that one tick of a session leaves for the next. A value of fixed size, about 30 kB, valid
/// only for the build that made it.
struct SessionState {
  RendererState renderer;                        ///< as HapticRenderer::checkpoint() gives it
  VelocityTracker tracker;                       ///< the latest readings
  Clutch clutch;                                 ///< whether it is held, and its fading
  std::optional<VirtualCoupling> coupling;       ///< no value: the session has no coupling
  std::optional<PassivityController> passivity;  ///< no value: the session controls no energy
  double source_work = 0.0;       ///< [J] sourceWork() of the renderer, up to the last tick
  std::uint64_t ticks = 0;        ///< number of ticks made
  std::uint64_t next_change = 0;  ///< index of the first of SessionSettings::changes not yet due
  double last_time = 0.0;         ///< [s]
  bool has_begun = false;         ///< a tick was made, so that `last_time` counts
};
static_assert(std::is_trivially_copyable_v<SessionState>);

/// The inputs and outputs of one tick.
struct SessionTick {
  std::uint64_t number = 0;  ///< from 0
  DeviceState reading;       ///< as it came
  /// [s] since the last reading: the servo's period at the first, 0 if the time did not increase or
  /// is not a number
  double dt = 0.0;
  HipState hip;                   ///< [world] the renderer's input; with a coupling, the tool
  TickResult result;              ///< [world] the renderer's result
  Vec3 unlimited{0.0, 0.0, 0.0};  ///< [N, world] the renderer's force before the limits
  Vec3 force{0.0, 0.0, 0.0};      ///< [N] in the device's frame: for the device
  Vec3 added{0.0, 0.0, 0.0};      ///< [N] the passivity controller's share of it
  std::int64_t renderer_ns = 0;   ///< [ns] of the renderer's update alone
  bool is_held = false;           ///< the clutch is held
  bool is_checkpoint = false;     ///< Session::checkpoint() is the state before this tick
  /// Number of the present scene: 0 is the first one, n the one of the n-th Session::offer().
  std::uint64_t scene = 0;
  /// This is the first tick in a new scene that could not take over the state of the probe: the
  /// probe begins as in a new session.
  bool begins_anew = false;
};

/// The result of Session::offer().
struct SceneOffer {
  std::uint64_t scene = 0;             ///< SessionTick::scene of the ticks in the new scene
  bool goes_on = false;                ///< CarriedState::goes_on
  std::vector<std::string> lost = {};  ///< CarriedState::lost
};

/// The part of a session that another thread may see while it runs.
struct SessionView {
  std::uint64_t number = 0;    ///< of the tick
  double time = 0.0;           ///< [s] of the device
  Vec3 hip{0.0, 0.0, 0.0};     ///< [m, world]
  Vec3 proxy{0.0, 0.0, 0.0};   ///< [m, world]
  Vec3 force{0.0, 0.0, 0.0};   ///< [N, world] after the limits
  RegionId region = kOutside;  ///< of the proxy
  std::uint32_t buttons = 0;   ///< DeviceState::buttons of the reading
  bool is_held = false;        ///< the clutch is held
};

/// Owns the renderer, the velocity tracker, the clutch, the stability guards and everything that
/// they keep between ticks; the scene is shared and const. Construction may throw and allocate;
/// step() never allocates, locks, throws or blocks. One thread at a time.
class PALPATE_EXPORT Session {
 public:
  /// Called after each tick of run(), in the servo thread: it must not allocate, lock, throw or
  /// block.
  using Listener = std::function<void(const SessionTick&, const HapticRenderer&)>;

  /// @throws Error (kInput) as makeRenderer(); (kUsage) for invalid velocity settings, servo
  /// settings, limits of the force, clutch button, changes, passivity or coupling; and as
  /// sceneBudget() for `loop`.
  explicit Session(ScenePtr scene, SessionSettings settings = {});
  ~Session();
  /// Afterwards `other` may only be destroyed or assigned to.
  Session(Session&& other) noexcept;
  /// Likewise; ends the session that was here before.
  Session& operator=(Session&& other) noexcept;

  /// One tick: device -> world by the scene's mapping (or as it is, for DeviceFrame::kWorld),
  /// velocity, clutch, coupling, renderer, and the force back through the coupling and the
  /// passivity controller. A reading that is not finite gives zero force.
  [[nodiscard]] SessionTick step(const DeviceState& reading, DeviceFrame frame) noexcept;

  /// step() for each reading of `device`, by runServo(), until that ends or `stop` is set. @throws
  /// Error as runServo().
  [[nodiscard]] ServoReport run(Device& device, const std::atomic<bool>& stop,
                                const Listener& listener = {});

  /// The same; each tick also goes into `recorder`, after its force was written. @throws Error as
  /// runServo().
  [[nodiscard]] ServoReport run(Device& device, const std::atomic<bool>& stop, Recorder& recorder);

  /// The state before the last tick whose SessionTick::is_checkpoint is set. A session with the
  /// same scene and settings that resume()s from it feels bit for bit what this one felt from there
  /// on.
  [[nodiscard]] const SessionState& checkpoint() const noexcept { return checkpoint_; }
  /// Goes on from a checkpoint of a session with the same scene and settings; contents that had
  /// changed before it are changed again. Returns false, and does nothing, if this session has
  /// already made a tick, or if `state` cannot be one of its states.
  [[nodiscard]] bool resume(const SessionState& state) noexcept;
  /// The number of the next tick.
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }

  /// The energy that the loop gave to the hand; null unless SessionSettings::passivity is given.
  [[nodiscard]] const PassivityObserver* observer() const noexcept {
    return passivity_ ? &passivity_->observer() : nullptr;
  }

  /// From any thread: the hand goes on in another scene, with a renderer that is made here in this
  /// call. While the servo thread runs, the present state is carried over by names (carryState()),
  /// up to the last region that the probe entered. The scene changes between two ticks; the force
  /// begins at zero and comes back within kSwapFade, or later if the limits of `settings` or of the
  /// scene hold its growth back. A scene that was offered earlier and not yet taken is dropped.
  /// Timed changes of contents do not apply in the new scene, and a record does not contain the
  /// swap. Passivity and coupling keep their first settings. Waits for the servo thread, about a
  /// second at most. One thread at a time; a call that throws is not counted in SceneOffer::scene.
  /// @throws Error (kInput) as makeRenderer().
  SceneOffer offer(ScenePtr scene, const RendererSettings& settings);
  /// From any thread: the last tick. No value before the first.
  [[nodiscard]] std::optional<SessionView> view() const noexcept;
  static constexpr double kSwapFade = 0.1;  ///< [s]
  /// A warning at set-up: the items of the scene that are stiffer than SessionSettings::loop can
  /// hold. Empty without `loop`. It does not change what is felt.
  [[nodiscard]] const std::vector<BudgetItem>& overBudget() const noexcept { return over_budget_; }

  /// The scene that is felt; immutable.
  [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
  /// The session's own renderer, for the thread that calls step(), between its calls.
  [[nodiscard]] HapticRenderer& renderer() noexcept { return *renderer_; }
  /// The same, read only.
  [[nodiscard]] const HapticRenderer& renderer() const noexcept { return *renderer_; }

 private:
  struct Shared;

  /// Switches to the scene that was offered, if there is one.
  void swapScene() noexcept;
  /// The part of `force` [N, world] that the hand gets, which after a swap grows slowly.
  [[nodiscard]] Vec3 afterSwap(const Vec3& force, double dt) noexcept;

  std::unique_ptr<Shared> shared_;
  ScenePtr scene_;
  SessionSettings settings_;
  std::unique_ptr<HapticRenderer> renderer_;
  VelocityTracker tracker_;
  Clutch clutch_;
  std::optional<VirtualCoupling> coupling_;
  std::optional<PassivityController> passivity_;
  double source_work_ = 0.0;  ///< [J] sourceWork() of the renderer, up to the last tick

  struct Felt {
    Vec3 force{0.0, 0.0, 0.0};  ///< [N, world]
    double stiffness = 0.0;     ///< [N/m] of the wall, at the hand; 0: not known
  };
  /// The renderer's force for the probe at `probe`, through the coupling if there is one, and
  /// before the clutch.
  [[nodiscard]] Felt feel(const Clutched& probe, DeviceFrame frame, SessionTick& tick) noexcept;
  /// Applies the changes of contents that are due.
  void changeUntil(double time) noexcept;
  void saveCheckpoint() noexcept;

  std::uint64_t ticks_ = 0;
  std::size_t next_change_ = 0;
  bool has_begun_ = false;
  double swap_fade_ = 1.0;  ///< [-] share of the force since the scene was swapped
  /// Limits the growth of the force after a swap; no value once the whole force is back.
  std::optional<ForceGuard> swap_guard_;
  /// SessionTick::begins_anew of the next tick.
  bool begins_anew_ = false;
  double last_time_ = 0.0;
  SessionState checkpoint_;
  std::vector<BudgetItem> over_budget_;
};

}  // namespace palpate::devices
