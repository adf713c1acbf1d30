#include "palpate/devices/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/devices/hand_guards.h"
#include "palpate/devices/record.h"
#include "palpate/devices/scene_swap.h"
#include "palpate/devices/seq_lock.h"
#include "servo_check.h"

namespace palpate::devices {
namespace {

/// [world] The result of the renderer's tick in the form that a coupling needs.
ToolForce toolForce(const HapticRenderer& renderer, const SessionTick& tick) noexcept {
  const ForceSlope slope = renderer.slope(tick.hip);
  return {tick.result.force, slope.normal,  slope.stiffness,
          slope.sideways,    slope.damping, slope.drag};
}

const Vec3 kBroken(std::numeric_limits<double>::quiet_NaN());

void checkLimit(double value, bool may_be, const char* name) {
  if (may_be) return;
  throw Error(ErrorKind::kUsage, {"session.limits", std::string(name) + " of the force cannot be " +
                                                        std::to_string(value)});
}

void check(const Scene& scene, const SessionSettings& settings) {
  checkServo(settings.servo, true);
  const ForceLimits& limits = settings.renderer.limits;
  checkLimit(limits.max_force, limits.max_force >= 0.0, "the largest length");
  checkLimit(limits.max_growth, limits.max_growth >= 0.0, "the growth");
  checkLimit(limits.ramp, limits.ramp >= 0.0 && std::isfinite(limits.ramp), "the ramp");
  checkLimit(limits.period, limits.period > 0.0 && std::isfinite(limits.period), "the period");
  if (settings.clutch_button < 0 || settings.clutch_button > 31) {
    throw Error(ErrorKind::kUsage, {"session.button", "a clutch button must be 0 to 31, not " +
                                                          std::to_string(settings.clutch_button)});
  }
  double last = -kInfinity;
  for (const ContentEvent& event : settings.changes) {
    if (!(event.time >= last)) {
      throw Error(ErrorKind::kUsage,
                  {"session.changes",
                   "changes of contents must be in order of time: " + std::to_string(event.time) +
                       " s comes after " + std::to_string(last) + " s"});
    }
    last = event.time;
  }
  for (const ContentEvent& event : settings.changes) {
    if (canChangeContent(scene, event.region, event.change)) continue;
    throw Error(ErrorKind::kUsage,
                {"session.changes", "region " + std::to_string(event.region) +
                                        " cannot have the content that is asked for at " +
                                        std::to_string(event.time) + " s"});
  }
}

}  // namespace

/// Data shared between threads.
struct Session::Shared {
  /// The renderer's state between two ticks, for a thread that asked for it.
  struct Snapshot {
    std::uint64_t request = 0;
    std::uint64_t offer = 0;    ///< number of the offer that brought its scene
    std::uint64_t entries = 0;  ///< regions that the probe has entered so far
    RendererState state;
  };
  struct Known {
    std::uint64_t number = 0;
    ScenePtr scene;
    RendererKind kind = RendererKind::kConstraint;
  };

  SceneSwap swap;
  SeqLock<SessionView> view;
  SeqLock<Snapshot> snapshot;
  std::atomic<std::uint64_t> asked{0};    ///< number of the last request for a snapshot
  std::atomic<std::uint64_t> handled{0};  ///< number of the last offer that was taken or put away
  std::atomic<bool> was_old{false};       ///< that offer was put away

  // Used by the servo thread only.
  std::uint64_t answered = 0;  ///< number of the last request that was answered
  OfferTag felt;               ///< of the present scene
  std::uint64_t entries = 0;

  // Used by the offering thread only.
  std::vector<Known> known;  ///< scenes that a snapshot may belong to
  std::uint64_t offers = 0;  ///< made so far
  std::uint64_t scenes = 0;  ///< offered so far

  /// For the offering thread: the present state. No value if the servo thread does not run.
  [[nodiscard]] std::optional<Snapshot> ask();
};

namespace {

/// [s] In this time a running servo thread makes a tick, even on a busy machine.
constexpr double kAnswer = 0.1;
/// The most attempts to offer a scene: an attempt fails if the probe goes on into another region
/// before the scene is taken.
constexpr int kMostOffers = 5;

/// Waits for `holds()`; false if it did not become true within kAnswer.
template <typename Holds>
bool waitFor(const Holds& holds) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  while (!holds()) {
    if (std::chrono::duration<double>(Clock::now() - begin).count() > kAnswer) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return true;
}

}  // namespace

std::optional<Session::Shared::Snapshot> Session::Shared::ask() {
  const std::uint64_t request = asked.load(std::memory_order_relaxed) + 1;
  asked.store(request, std::memory_order_release);
  std::optional<Snapshot> seen;
  const bool is_there = waitFor([&] {
    seen = snapshot.load();
    return seen && seen->request == request;
  });
  return is_there ? seen : std::nullopt;
}

Session::~Session() = default;
Session::Session(Session&& other) noexcept = default;
Session& Session::operator=(Session&& other) noexcept = default;

Session::Session(ScenePtr scene, SessionSettings settings)
    : shared_(std::make_unique<Shared>()),
      scene_(std::move(scene)),
      settings_(std::move(settings)),
      renderer_(makeRenderer(scene_, settings_.renderer)),
      tracker_(settings_.velocity) {
  check(*scene_, settings_);
  shared_->known.push_back({0, scene_, settings_.renderer.kind.value_or(scene_->renderer())});
  DeviceMapping asked = scene_->device();
  if (settings_.passivity) asked.passivity.reset();
  if (settings_.coupling) asked.coupling.reset();
  HandGuards guards = guardsOf(asked, settings_.loop, 1.0 / settings_.servo.rate);
  if (settings_.passivity) guards.passivity = settings_.passivity;
  if (settings_.coupling) guards.coupling = settings_.coupling;
  if (guards.coupling) coupling_.emplace(*guards.coupling);
  if (guards.passivity) passivity_.emplace(*guards.passivity);
  if (!settings_.loop) return;
  LoopModel loop = *settings_.loop;
  loop.period = 1.0 / settings_.servo.rate;
  loop.velocity = settings_.velocity;
  for (BudgetItem& item : sceneBudget(*scene_, loop)) {
    if (item.isAbove()) over_budget_.push_back(std::move(item));
  }
}

SessionTick Session::step(const DeviceState& reading, DeviceFrame frame) noexcept {
  swapScene();
  SessionTick tick;
  tick.number = ticks_;
  tick.reading = reading;
  tick.scene = shared_->felt.scene;
  tick.begins_anew = begins_anew_;
  begins_anew_ = false;
  tick.is_checkpoint =
      settings_.checkpoint_every > 0 && ticks_ > 0 && ticks_ % settings_.checkpoint_every == 0;
  if (tick.is_checkpoint) saveCheckpoint();
  ++ticks_;
  if (std::isfinite(reading.time)) {
    tick.dt = has_begun_ ? std::max(0.0, reading.time - last_time_) : 1.0 / settings_.servo.rate;
    last_time_ = reading.time;
    has_begun_ = true;
  }

  const DeviceMapping& mapping = scene_->device();
  const bool is_mapped = frame == DeviceFrame::kDevice;
  const Vec3 position = is_mapped ? mapping.toWorld(reading.position) : reading.position;
  // The velocity is computed from the device's positions, since a released clutch must not look
  // like a jump of the hand; nor must a broken reading.
  const Vec3 velocity =
      tracker_.add(reading.time, HapticRenderer::isInReach(position) ? reading.position : kBroken)
          .value;
  tick.is_held = mapping.clutch &&
                 (reading.buttons >> static_cast<unsigned>(settings_.clutch_button) & 1U) != 0;
  const bool is_sound = HapticRenderer::isInReach(position) && isFinite(velocity);
  // A broken reading neither engages nor releases the clutch.
  const Clutched now =
      is_sound ? clutch_.step(position, is_mapped ? mapping.velocityToWorld(velocity) : velocity,
                              tick.is_held, tick.dt)
               : Clutched{position, velocity, 0.0};

  changeUntil(reading.time);
  const double share = swap_fade_ * now.share;
  const Felt felt = feel(now, frame, tick);
  shared_->entries += renderer_->entries().size();
  const Vec3 given = afterSwap(share * felt.force, tick.dt);
  tick.force = is_mapped ? mapping.forceToDevice(given) : given;
  if (passivity_) {
    const double work = renderer_->sourceWork();
    const double source = (is_mapped ? mapping.workAtHand() : 1.0) * (work - source_work_);
    source_work_ = work;
    const PassivityTick guarded = passivity_->step(is_sound ? reading.position : kBroken, tick.dt,
                                                   tick.force, share * felt.stiffness, source);
    tick.force = guarded.force;
    tick.added = guarded.added;
  }
  swap_fade_ = std::min(1.0, swap_fade_ + tick.dt / kSwapFade);
  shared_->view.store({tick.number, reading.time, now.position, tick.result.proxy,
                       tick.result.force, tick.result.region, reading.buttons, tick.is_held});
  return tick;
}

Session::Felt Session::feel(const Clutched& probe, DeviceFrame frame, SessionTick& tick) noexcept {
  const bool is_coupled =
      coupling_ && HapticRenderer::isInReach(probe.position) && isFinite(probe.velocity);
  // The coupling's stiffness is defined at the hand, so it works in the hand's scale.
  const DeviceMapping& mapping = scene_->device();
  const bool is_mapped = frame == DeviceFrame::kDevice;
  const double scale = is_mapped ? mapping.scale : 1.0;
  const double force = is_mapped ? mapping.force : 1.0;
  tick.hip = {probe.position, probe.velocity, tick.dt};
  if (is_coupled) {
    const ToolMotion tool = coupling_->reach(probe.position / scale, tick.dt);
    tick.hip.position = scale * tool.position;
    tick.hip.velocity = scale * tool.velocity;
  }
  const auto before = std::chrono::steady_clock::now();
  tick.result = renderer_->update(tick.hip);
  const auto after = std::chrono::steady_clock::now();
  tick.unlimited = renderer_->unlimitedForce();
  tick.renderer_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(after - before).count();
  if (!is_coupled && !passivity_) return {tick.result.force, 0.0};
  ToolForce answer = toolForce(*renderer_, tick);
  answer.force *= force;
  for (double* slope : {&answer.stiffness, &answer.sideways, &answer.damping, &answer.drag}) {
    *slope *= force * scale;
  }
  if (!is_coupled) return {tick.result.force, answer.stiffness};
  return {coupling_->push(answer) / force, coupling_->felt(answer.stiffness)};
}

std::optional<SessionView> Session::view() const noexcept { return shared_->view.load(); }

SceneOffer Session::offer(ScenePtr scene, const RendererSettings& settings) {
  auto renderer = makeRenderer(scene, settings);
  Shared& shared = *shared_;
  const RendererKind kind = settings.kind.value_or(scene->renderer());
  SceneOffer out{.scene = ++shared.scenes};
  const double max_growth = settings.limits.over(scene->forceLimits()).max_growth;
  const auto give = [&](std::optional<std::uint64_t> entries) {
    const std::uint64_t number = ++shared.offers;
    shared.known.push_back({number, scene, kind});
    if (const auto forgotten = shared.swap.offer(
            {scene, std::move(renderer), {number, out.scene, out.goes_on, max_growth}, entries})) {
      std::erase_if(shared.known, [&](const Shared::Known& k) { return k.number == *forgotten; });
    }
    return number;
  };
  for (int i = 0; i < kMostOffers; ++i) {
    const auto snapshot = shared.ask();
    if (!snapshot) break;  // the servo thread does not run, so there is no state to carry over
    // Scenes older than the present one are not needed any more.
    std::erase_if(shared.known, [&](const Shared::Known& k) { return k.number < snapshot->offer; });
    const Shared::Known& from = shared.known.front();
    CarriedState carried = carryState(snapshot->state, from.kind, *from.scene, *scene);
    if (!renderer) renderer = makeRenderer(scene, settings);
    const bool is_carried = renderer->setState(carried.state);
    out.goes_on = is_carried && carried.goes_on;
    out.lost = std::move(carried.lost);
    // If the hand keeps going in and out, the last attempt uses the state however old it is: the
    // proxy goes on from there.
    const bool is_last = i + 1 == kMostOffers;
    const std::uint64_t number =
        give(is_carried && !is_last ? std::optional(snapshot->entries) : std::nullopt);
    const bool is_handled =
        waitFor([&] { return shared.handled.load(std::memory_order_acquire) >= number; });
    // An offer that was not handled in time may still be put away: it has to be made again.
    const bool is_taken = is_handled && !shared.was_old.load(std::memory_order_acquire);
    if (is_taken || is_last) return out;
  }
  out.goes_on = false;
  if (!renderer) renderer = makeRenderer(scene, settings);
  (void)give({});
  return out;
}

void Session::swapScene() noexcept {
  Shared& shared = *shared_;
  if (const std::uint64_t asked = shared.asked.load(std::memory_order_acquire);
      asked != shared.answered && ticks_ > 0) {
    shared.answered = asked;
    shared.snapshot.store({asked, shared.felt.number, shared.entries, renderer_->state()});
  }
  OfferTag tag;
  const SceneSwap::Taken taken = shared.swap.take(scene_, renderer_, shared.entries, tag);
  if (taken == SceneSwap::Taken::kNothing) return;
  const bool is_new = taken == SceneSwap::Taken::kNew;
  if (is_new) {
    shared.felt = tag;
    begins_anew_ = !tag.goes_on;
    swap_fade_ = 0.0;
    swap_guard_.emplace(
        ForceLimits{.max_growth = tag.max_growth, .period = 1.0 / settings_.servo.rate});
    next_change_ = settings_.changes.size();
    if (coupling_) coupling_->letGo();
    source_work_ = renderer_->sourceWork();
  }
  shared.was_old.store(!is_new, std::memory_order_release);
  shared.handled.store(tag.number, std::memory_order_release);
}

Vec3 Session::afterSwap(const Vec3& force, double dt) noexcept {
  if (!swap_guard_) return force;
  // A fade alone would let the force grow faster than its limit allows.
  const Vec3 given = swap_guard_->apply(force, dt);
  if (swap_fade_ >= 1.0 && given == force) swap_guard_.reset();
  return given;
}

void Session::changeUntil(double time) noexcept {
  for (; next_change_ < settings_.changes.size() && settings_.changes[next_change_].time <= time;
       ++next_change_) {
    const ContentEvent& event = settings_.changes[next_change_];
    (void)renderer_->setContent(event.region, event.change);  // each change was tried beforehand
  }
}

void Session::saveCheckpoint() noexcept {
  checkpoint_.renderer = renderer_->checkpoint();
  checkpoint_.tracker = tracker_;
  checkpoint_.clutch = clutch_;
  checkpoint_.coupling = coupling_;
  checkpoint_.passivity = passivity_;
  checkpoint_.source_work = source_work_;
  checkpoint_.ticks = ticks_;
  checkpoint_.next_change = next_change_;
  checkpoint_.last_time = last_time_;
  checkpoint_.has_begun = has_begun_;
}

bool Session::resume(const SessionState& state) noexcept {
  if (ticks_ > 0 || state.next_change > settings_.changes.size()) return false;
  if (state.coupling.has_value() != coupling_.has_value() ||
      state.passivity.has_value() != passivity_.has_value()) {
    return false;
  }
  if (!state.tracker.isSound() || (state.passivity && !state.passivity->isSound())) return false;
  if (!renderer_->setState(state.renderer)) return false;
  for (; next_change_ < state.next_change; ++next_change_) {
    const ContentEvent& event = settings_.changes[next_change_];
    (void)renderer_->setContent(event.region, event.change);
  }
  tracker_ = state.tracker;
  clutch_ = state.clutch;
  coupling_ = state.coupling;
  passivity_ = state.passivity;
  source_work_ = state.source_work;
  ticks_ = state.ticks;
  last_time_ = state.last_time;
  has_begun_ = state.has_begun;
  // The state was taken at the beginning of a tick. The next tick here begins by taking it again,
  // as that tick did, so that both go on alike.
  return true;
}

ServoReport Session::run(Device& device, const std::atomic<bool>& stop, const Listener& listener) {
  const DeviceFrame frame = device.info().frame;
  const auto tick = [&](const DeviceState& reading) {
    const SessionTick now = step(reading, frame);
    if (listener) listener(now, *renderer_);
    return now.force;
  };
  return runServo(device, tick, settings_.servo, stop);
}

ServoReport Session::run(Device& device, const std::atomic<bool>& stop, Recorder& recorder) {
  const DeviceFrame frame = device.info().frame;
  SessionTick now;
  const auto tick = [&](const DeviceState& reading) {
    now = step(reading, frame);
    return now.force;
  };
  return runServo(device, tick, settings_.servo, stop, [&](const ServoTurn& turn) {
    recorder.add(now, turn, renderer_->entries(), now.is_checkpoint ? &checkpoint_ : nullptr);
  });
}

}  // namespace palpate::devices
