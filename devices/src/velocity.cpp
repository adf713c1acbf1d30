#include "palpate/devices/velocity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "palpate/core/error.h"

namespace palpate::devices {

VelocityTracker::VelocityTracker(const VelocitySettings& settings) : settings_(settings) {
  if (settings.estimator > VelocityEstimator::kAdaptiveWindow) {
    throw Error(ErrorKind::kUsage,
                {"velocity.estimator", "unknown velocity estimator: number " +
                                           std::to_string(static_cast<int>(settings.estimator))});
  }
  if (!(settings.window > 0.0) || !std::isfinite(settings.window)) {
    throw Error(ErrorKind::kUsage,
                {"velocity.window", "the window of a velocity estimator must be above 0 s, not " +
                                        std::to_string(settings.window)});
  }
  if (!(settings.noise >= 0.0) || !std::isfinite(settings.noise)) {
    throw Error(ErrorKind::kUsage,
                {"velocity.noise", "the noise of a velocity estimator must be 0 m or more, not " +
                                       std::to_string(settings.noise)});
  }
}

Velocity VelocityTracker::add(double time, const Vec3& position) noexcept {
  if (!isFinite(position) || !std::isfinite(time)) {
    reset();
    return {Vec3(std::numeric_limits<double>::quiet_NaN()), Vec3(0.0)};
  }
  const double before = std::exchange(latest_, time);
  if (count_ > 0 && !(time > at(0).time)) {
    if (!(time > before)) return last_;
    reset();
  }
  if (count_ > 0 && time - at(0).time > kLongestGap) reset();
  newest_ = (newest_ + 1) % kCapacity;
  readings_[newest_] = {time, position};
  count_ = std::min(count_ + 1, kCapacity);
  if (count_ == 1) return last_ = {};
  switch (settings_.estimator) {
    case VelocityEstimator::kBackwardDifference: {
      const double span = time - at(1).time;
      return last_ = {(position - at(1).position) / span, Vec3(0.5 * span)};
    }
    case VelocityEstimator::kLeastSquares:
      return last_ = leastSquares(reach());
    case VelocityEstimator::kAdaptiveWindow:
      break;
  }
  return last_ = adaptive(reach());
}

std::size_t VelocityTracker::reach() const noexcept {
  // Times are sums of periods, so a reading that is beyond the window only by rounding belongs to
  // it.
  const double window = settings_.window * (1.0 + 1e-9);
  std::size_t back = 1;
  while (back + 1 < count_ && at(0).time - at(back + 1).time <= window) ++back;
  return back;
}

Velocity VelocityTracker::leastSquares(std::size_t reach) const noexcept {
  const auto number = static_cast<double>(reach + 1);
  double mean_time = 0.0;
  Vec3 mean(0.0);
  for (std::size_t n = 0; n <= reach; ++n) {
    mean_time += (at(n).time - at(0).time) / number;
    mean += (at(n).position - at(0).position) / number;
  }
  double spread = 0.0;
  Vec3 sum(0.0);
  for (std::size_t n = 0; n <= reach; ++n) {
    const double off = at(n).time - at(0).time - mean_time;
    spread += off * off;
    sum += off * (at(n).position - at(0).position - mean);
  }
  return {sum / spread, Vec3(-mean_time)};
}

bool VelocityTracker::keepsToChord(int axis, std::size_t back) const noexcept {
  const double span = at(0).time - at(back).time;
  const double slope = (at(0).position[axis] - at(back).position[axis]) / span;
  for (std::size_t n = 1; n < back; ++n) {
    const double there = at(0).position[axis] - slope * (at(0).time - at(n).time);
    if (std::fabs(there - at(n).position[axis]) > settings_.noise) return false;
  }
  return true;
}

Velocity VelocityTracker::adaptive(std::size_t reach) const noexcept {
  Velocity out;
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t back = 1;
    while (back < reach && keepsToChord(axis, back + 1)) ++back;
    const double span = at(0).time - at(back).time;
    out.value[axis] = (at(0).position[axis] - at(back).position[axis]) / span;
    out.delay[axis] = 0.5 * span;
  }
  return out;
}

}  // namespace palpate::devices
