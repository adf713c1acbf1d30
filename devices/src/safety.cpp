#include "palpate/devices/safety.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::devices {
namespace {

constexpr double kNanosecond = 1e-9;  // [s]

/// Converts to [ns]; a time that is too long becomes the largest number. NaN and negative times
/// count as 0.
std::int64_t nanoseconds(double seconds) noexcept {
  constexpr double kLongest = 9e9;  // [s] 285 years
  if (seconds >= kLongest) return std::numeric_limits<std::int64_t>::max();
  return seconds > 0.0 ? std::llround(seconds / kNanosecond) : 0;
}

double seconds(std::int64_t ns) noexcept { return kNanosecond * static_cast<double>(ns); }

/// The limit itself, or 0 if it is NaN or negative: such a limit permits nothing.
double permitted(double limit) noexcept { return limit > 0.0 ? limit : 0.0; }

}  // namespace

Safety::Safety(const SafetyLimits& limits, double max_force, std::int64_t watchdog,
               std::int64_t recovery, std::int64_t turn) noexcept
    : limits_(limits),
      max_force_(permitted(max_force)),
      watch_(std::max(std::min(watchdog, nanoseconds(limits.silence)), 2 * turn),
             std::max(recovery, nanoseconds(limits.ramp))),
      guard_({.max_growth = limits.max_growth, .period = seconds(turn)}) {}

void Safety::open(std::int64_t now) noexcept {
  step(SafetyEvent::kOpened);
  now_ = now;
  last_reply_ = now;
  last_asked_ = now;
  needs_ramp_ = limits_.ramp > 0.0;
}

void Safety::close() noexcept { step(SafetyEvent::kClosing); }

void Safety::fail(SafetyFault fault) noexcept {
  if (state_ == SafetyState::kClosed || state_ == SafetyState::kFault) return;
  step(SafetyEvent::kFailed);
  fault_ = fault;
  guard_.reset();
}

void Safety::breakOff() noexcept {
  step(SafetyEvent::kBroken);
  guard_.reset();
}

void Safety::strike(int& count, SafetyFault fault) noexcept {
  if (limits_.strikes > 0 && ++count >= limits_.strikes) fail(fault);
}

void Safety::hang(std::int64_t duration) noexcept {
  ++counts_.hangs;
  breakOff();
  needs_ramp_ = true;
  if (duration >= nanoseconds(limits_.hang_fault)) fail(SafetyFault::kHung);
}

bool Safety::jumps(const Vec3& position) const noexcept {
  if (last_place_ < 0 || limits_.jump_speed == kInfinity) return false;
  const double way = glm::length(position - place_);
  const double reach =
      permitted(limits_.jump_speed) * seconds(now_ - last_place_) + permitted(limits_.jump_slack);
  return !(way <= reach);
}

void Safety::track(const Vec3& position) noexcept {
  if (last_place_ >= 0) {
    const double tau = SafetyLimits::kSpeedFilter;
    const double dt = std::min(tau, seconds(now_ - last_place_));
    speed_ += (position - place_ - dt * speed_) / tau;
  }
  place_ = position;
  last_place_ = now_;
  if (limits_.max_speed != kInfinity && !(glm::length(speed_) <= permitted(limits_.max_speed))) {
    fail(SafetyFault::kSpeed);
  }
}

ReadingVerdict Safety::read(std::int64_t now, DeviceStatus status,
                            const DeviceState& fresh) noexcept {
  now_ = std::max(now_, now);
  if (state_ == SafetyState::kClosed || state_ == SafetyState::kFault) return ReadingVerdict::kNone;
  ReadingVerdict verdict = ReadingVerdict::kNone;
  if (status >= DeviceStatus::kTimeout) fail(SafetyFault::kDevice);
  if (status == DeviceStatus::kOk) {
    last_reply_ = now_;
    verdict = ReadingVerdict::kSound;
    const bool is_finite = isFinite(fresh.position) && isFinite(fresh.velocity);
    // Before an origin is known, positions have no meaning.
    const bool is_place = is_finite && fresh.is_homed;
    if (is_place && jumps(fresh.position)) {
      verdict = ReadingVerdict::kDropped;
      ++counts_.jumps;
      strike(jump_strikes_, SafetyFault::kJump);
    } else if (is_place) {
      jump_strikes_ = 0;
      track(fresh.position);
    }
    if (!fresh.is_homed && state_ >= SafetyState::kIdle) fail(SafetyFault::kHomingLost);
    step(fresh.is_homed ? SafetyEvent::kHomed : SafetyEvent::kReply);
    has_reading_ = has_reading_ || verdict == ReadingVerdict::kSound;
  }
  if (has_reading_) {
    const bool was_silent = watch_.hasExpired();
    watch_.turn(now_, verdict == ReadingVerdict::kSound);
    if (watch_.hasExpired() && !was_silent) breakOff();
  }
  if (now_ - last_reply_ >= nanoseconds(limits_.silence_fault)) fail(SafetyFault::kSilence);
  return state_ == SafetyState::kFault ? ReadingVerdict::kNone : verdict;
}

bool Safety::ticks() const noexcept {
  return has_reading_ && !watch_.hasExpired() &&
         (state_ == SafetyState::kIdle || permitsForce(state_));
}

void Safety::warm(double dt) noexcept {
  if (limits_.continuous_force == kInfinity) return;
  // The last force was held during `dt`.
  const double share = limits_.thermal_time > 0.0 ? -std::expm1(-dt / limits_.thermal_time) : 1.0;
  heat_ += (load_ - heat_) * share;
  counts_.heat = std::max(counts_.heat, heat_);
  load_ = 0.0;
}

Vec3 Safety::cooled(const Vec3& force) noexcept {
  if (limits_.continuous_force == kInfinity) return force;
  const double forever = permitted(limits_.continuous_force);
  const double length = glm::length(force);
  // From warm to hot, the permitted force falls from the maximum to the continuous force.
  const double cold = std::clamp((1.0 - heat_) / (1.0 - SafetyLimits::kWarm), 0.0, 1.0);
  const double most = forever + (std::max(max_force_, forever) - forever) * cold;
  if (length <= most) return force;
  ++counts_.warm;
  return force * (most / length);
}

SafeForce Safety::ask(const Vec3& wanted, const DeviceState& answers) noexcept {
  SafeForce out;
  const double dt = seconds(now_ - last_asked_);
  last_asked_ = now_;
  warm(dt);
  if (!ticks()) return out;
  if (state_ == SafetyState::kIdle) {
    step(SafetyEvent::kAsked);
    if (needs_ramp_) watch_.restart();
    needs_ramp_ = false;
  }
  out.share = watch_.share();
  if (state_ == SafetyState::kRamping && out.share >= 1.0) step(SafetyEvent::kRamped);
  if (!isFinite(wanted) || !isFinite(answers.position) || !isFinite(answers.velocity)) {
    out.is_zeroed = true;
    ++counts_.zeroed;
    breakOff();
    needs_ramp_ = needs_ramp_ || limits_.ramp > 0.0;
    strike(finite_strikes_, SafetyFault::kNotFinite);
    return out;
  }
  finite_strikes_ = 0;
  out.force = wanted;
  if (const double length = glm::length(wanted); length > max_force_) {
    out.force *= max_force_ / length;
    out.is_shortened = true;
    ++counts_.shortened;
  }
  out.force *= out.share;
  out.force = guard_.apply(cooled(out.force), dt);
  const double forever = permitted(limits_.continuous_force);
  load_ = forever > 0.0 ? glm::dot(out.force, out.force) / (forever * forever) : 0.0;
  return out;
}

}  // namespace palpate::devices
