#include "palpate/render/force_guard.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// The limit itself, or 0 if it is NaN or negative: such a limit permits nothing.
double permitted(double limit) noexcept { return limit > 0.0 ? limit : 0.0; }

}  // namespace

Vec3 ForceGuard::apply(const Vec3& force, double dt) noexcept {
  const double step = std::min(permitted(dt), permitted(limits_.period));
  const double finite_step = std::isfinite(dt) ? step : 0.0;
  const double length = glm::length(force);
  Vec3 wanted = force;
  // The components may be finite and only their squares overflow. Then the direction is not
  // certain, so let go.
  if (!std::isfinite(length)) wanted = Vec3(0.0);
  const double most = permitted(limits_.max_force);
  if (std::isfinite(length) && length > most) wanted *= most / length;
  // Written so that a ramp of NaN holds the force at zero.
  if (!(age_ >= limits_.ramp)) wanted *= limits_.ramp > 0.0 ? age_ / limits_.ramp : 0.0;
  age_ += finite_step;
  last_ = slewed(wanted, finite_step);
  return last_;
}

Vec3 ForceGuard::slewed(const Vec3& wanted, double step) const noexcept {
  if (limits_.max_growth == kInfinity) return wanted;
  const double reach = permitted(limits_.max_growth) * step;
  // The share of the last force that is nearest to the wanted one.
  const double square = glm::dot(last_, last_);
  const double share = square > 0.0 ? std::clamp(glm::dot(wanted, last_) / square, 0.0, 1.0) : 0.0;
  const Vec3 kept = share * last_;
  const Vec3 more = wanted - kept;
  const double length = glm::length(more);
  return length <= reach ? wanted : kept + more * (reach / length);
}

bool ForceGuard::isSound() const noexcept { return isFinite(last_) && age_ >= 0.0; }

void ForceGuard::reset() noexcept {
  age_ = 0.0;
  last_ = Vec3(0.0);
}

}  // namespace palpate
