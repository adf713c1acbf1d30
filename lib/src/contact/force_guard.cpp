#include "palpate/contact/force_guard.h"

#include <algorithm>

namespace palpate {

Vec3 ForceGuard::apply(const Vec3& force, double dt) noexcept {
  const double step = dt > 0.0 && std::isfinite(dt) ? dt : 0.0;
  double magnitude = glm::length(force);
  Vec3 out = force;
  if (!std::isfinite(magnitude)) {
    // Components may be finite and only their squares too large; without a sure direction, let go.
    magnitude = 0.0;
    out = Vec3(0.0);
  }
  double allowed = limits_.max_force;
  if (std::isfinite(limits_.max_growth)) {
    allowed = std::min(allowed, magnitude_ + limits_.max_growth * step);
  }
  if (magnitude > allowed) {
    out *= allowed / magnitude;
    magnitude = allowed;
  }
  if (age_ < limits_.ramp) {
    const double share = age_ / limits_.ramp;
    out *= share;
    magnitude *= share;
  }
  age_ += step;
  magnitude_ = magnitude;
  return out;
}

void ForceGuard::reset() noexcept {
  age_ = 0.0;
  magnitude_ = 0.0;
}

}  // namespace palpate
