#include "palpate/devices/passivity.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "palpate/core/error.h"

namespace palpate::devices {
namespace {

/// The largest error of a step in space, in encoder steps: both its ends may be wrong by half a
/// step along each axis.
const double kEncoderDiagonal = std::sqrt(3.0);

constexpr double kAtRest = 1e-6;  // [m/s]

/// [-] In units of mass / T: half of the damping below which a sampled and held damper on a mass is
/// stable. At that limit the solution z = exp(j a) of the characteristic equation z^(d+1) (z - 1) /
/// (z + 1) = -alpha T / (2 m) has a = pi / (2 (d + 1)).
double halfOfStableDamping(int delay) { return std::tan(std::numbers::pi / (4.0 * (delay + 1))); }

Error usageError(const char* name, const std::string& message) {
  return Error(ErrorKind::kUsage, {std::string("passivity.") + name, message});
}

void check(const PassivitySettings& s) {
  const auto above = [](const char* name, const char* what, double value) {
    if (value > 0.0 && std::isfinite(value)) return;
    throw usageError(name, std::string(what) + " must be above 0, not " + std::to_string(value));
  };
  const auto at_least = [](const char* name, const char* what, double value) {
    if (value >= 0.0 && std::isfinite(value)) return;
    throw usageError(name, std::string(what) + " must be 0 or more, not " + std::to_string(value));
  };
  above("mass", "the device's mass [kg]", s.mass);
  above("period", "the period of the loop [s]", s.period);
  at_least("damping", "the device's damping [N s/m]", s.damping);
  at_least("friction", "the device's friction [N]", s.friction);
  at_least("encoder", "the encoder's step [m]", s.encoder);
  if (!(s.max_force > 0.0)) throw usageError("max_force", "the largest force must be above 0 N");
  if (s.delay < 0 || s.delay > PassivityObserver::kMostDelay) {
    throw usageError("delay", "the delay must be 0 to " +
                                  std::to_string(PassivityObserver::kMostDelay) + " ticks, not " +
                                  std::to_string(s.delay));
  }
  if (!s.hand_force) return;
  at_least("hand_force", "the hand's largest force [N]", *s.hand_force);
  if (s.delay > 0) {
    throw usageError("hand_force",
                     "the hand's force can bound the energy only without a delay: leave it out, "
                     "or set the delay to 0");
  }
}

/// [N s/m]
double mostDamping(const PassivitySettings& s) {
  return std::min(PassivityController::kDampingShare, halfOfStableDamping(s.delay)) * s.mass /
         s.period;
}

/// [N/m]
double mostStiffnessOf(const PassivitySettings& s) {
  if (!s.controls) return kInfinity;
  const double late = (0.5 + s.delay) * s.period;  // [s]
  const double linear = 0.5 * (mostDamping(s) + s.damping) / late;
  if (!(s.friction > 0.0) || !(s.encoder > 0.0)) return linear;
  return std::min(linear, PassivityController::kFrictionShare * 2.0 * s.friction / s.encoder);
}

}  // namespace

PassivityObserver::PassivityObserver(const PassivitySettings& settings)
    : damping_(settings.damping),
      friction_(settings.friction),
      unsure_(kEncoderDiagonal * settings.encoder),
      half_step_(0.5 * settings.encoder),
      max_force_(settings.max_force),
      delay_(settings.delay) {
  check(settings);
}

void PassivityObserver::add(const Vec3& position, double dt, double source) noexcept {
  const Vec3 before = held_;
  held_ = written_[next_];
  moved_ = has_position_ ? position - position_ : Vec3(0.0);
  position_ = position;
  has_position_ = true;
  const double work = glm::dot(held_, moved_) - source;
  const double way = std::max(0.0, glm::length(moved_) - unsure_);
  const double income = friction_ * way + (dt > 0.0 ? damping_ * way * way / dt : 0.0);
  const Vec3 change = held_ - before;
  doubt_ += half_step_ * (std::fabs(change.x) + std::fabs(change.y) + std::fabs(change.z));
  given_ += work;
  reserve_ += income - work;
  lowest_ = std::min(lowest_, reserve_);
  // Energy that was earned in free motion must not be spent in the next contact.
  if (held_.x == 0.0 && held_.y == 0.0 && held_.z == 0.0) reserve_ = std::min(reserve_, kSeed);
}

void PassivityObserver::hold(const Vec3& force) noexcept {
  // If the square of a force overflows, its length is infinite too, and zero is held.
  written_[next_] = glm::dot(force, force) > max_force_ * max_force_
                        ? force * (max_force_ / glm::length(force))
                        : force;
  next_ = next_ == static_cast<std::size_t>(delay_) ? 0 : next_ + 1;
}

PassivityController::PassivityController(const PassivitySettings& settings)
    : observer_(settings),
      per_period_(1.0 / settings.period),
      most_damping_(mostDamping(settings)),
      most_stiffness_(mostStiffnessOf(settings)),
      encoder_(settings.encoder),
      least_step_(kAtRest * settings.period),
      travel_(0.5 * settings.period * settings.period / settings.mass),
      margin_(2.0 * travel_ * settings.hand_force.value_or(0.0) + settings.encoder),
      controls_(settings.controls),
      bounds_(settings.controls && settings.hand_force.has_value()) {}

PassivityTick PassivityController::step(const Vec3& position, double dt, const Vec3& force,
                                        double stiffness, double source) noexcept {
  PassivityTick out;
  if (!isFinite(position) || !isFinite(force)) {
    observer_.hold(Vec3(0.0));
    scale_ = 1.0;
    return out;
  }
  observer_.add(position, dt, scale_ * source);
  scale_ = stiffness > most_stiffness_ ? most_stiffness_ / stiffness : 1.0;
  out.force = scale_ * force;
  if (controls_) {
    const bool is_wanted = force.x != 0.0 || force.y != 0.0 || force.z != 0.0;
    is_damping_ = is_wanted && (is_damping_ || observer_.reserve() < 0.0);
    if (is_damping_ || observer_.reserve() < 0.0) out.force = damped(out.force);
  }
  if (bounds_) out.force = bounded(out.force);
  out.added = out.force - force;
  observer_.hold(out.force);
  return out;
}

Vec3 PassivityController::sureStep() const noexcept {
  const Vec3& moved = observer_.moved();
  const double way = glm::length(moved);
  if (way < least_step_ || way <= encoder_) return Vec3(0.0);
  return (1.0 - encoder_ / way) * moved;
}

Vec3 PassivityController::damped(const Vec3& force) const noexcept {
  const Vec3 moved = sureStep();
  const double square = glm::dot(moved, moved);
  if (!(square > 0.0)) return force;
  // alpha / T, with alpha = -reserve / (T |v|^2).
  const double most = most_damping_ * per_period_;
  const double need = std::clamp(-observer_.reserve() / square, 0.0, most);
  const Vec3 damped = force - need * moved;
  const double size = glm::length(force);
  if (!is_damping_ || !(size > 0.0) || !std::isfinite(size)) return damped;
  const double along = glm::dot(force, moved) / size;
  const double more = std::min((most - need) * along, std::max(0.0, size - need * along));
  return damped - (more / size) * force;
}

Vec3 PassivityController::bounded(const Vec3& force) const noexcept {
  const double square = glm::dot(force, force);
  if (!(square > 0.0)) return force;
  const double size = std::sqrt(square);
  const double along = glm::dot(force, observer_.moved() + travel_ * observer_.held());
  const double reserve = std::max(0.0, observer_.reserve());
  // The most that the force can give until the next tick. Most forces give no more than the
  // reserve, and need no root.
  if (along + margin_ * size + travel_ * square <= reserve) return force;
  const double ahead = along / size + margin_;
  const double root = std::sqrt(ahead * ahead + 4.0 * travel_ * reserve);
  // The same root, in the form that does not subtract nearly equal numbers.
  const double most =
      ahead > 0.0 ? 2.0 * reserve / (ahead + root) : (root - ahead) / (2.0 * travel_);
  return size > most ? most / size * force : force;
}

}  // namespace palpate::devices
