#include "palpate/devices/stability.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "closed_loop.h"

namespace palpate::devices {
namespace {

/// The first value of a geometric sequence from `least` on at which `is_good` fails, refined by
/// bisection; infinite if it is true all the way to `most`, 0 if it never is.
template <typename Test>
double firstFailure(double least, double most, const Test& is_good) {
  constexpr int kSteps = 400;  // 5 % each, over the nine decades of a stiffness
  const double ratio = std::pow(most / least, 1.0 / kSteps);
  double good = 0.0;
  double bad = least;
  for (int i = 0; i <= kSteps && is_good(bad); ++i) {
    good = bad;
    bad *= ratio;
    if (i == kSteps) return kInfinity;
  }
  if (good == 0.0) return 0.0;
  while (bad - good > 1e-12 * bad) {
    const double middle = 0.5 * (good + bad);
    if (!(middle > good && middle < bad)) break;
    (is_good(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace

std::vector<double> velocityWeights(const VelocitySettings& settings, double period) {
  if (settings.estimator == VelocityEstimator::kBackwardDifference) {
    return {1.0 / period, -1.0 / period};
  }
  // As in the tracker: the readings within the window, but no more than it keeps.
  const double fit = std::floor(settings.window * (1.0 + 1e-9) / period);
  const double most = static_cast<double>(VelocityTracker::kCapacity) - 1.0;
  const double n = std::clamp(fit, 1.0, most);
  std::vector<double> weights(static_cast<std::size_t>(n) + 1, 0.0);
  if (settings.estimator == VelocityEstimator::kAdaptiveWindow) {
    weights.front() = 1.0 / (n * period);
    weights.back() = -1.0 / (n * period);
    return weights;
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = 6.0 * (n - 2.0 * static_cast<double>(i)) / (period * n * (n + 1.0) * (n + 2.0));
  }
  return weights;
}

double growthOf(const LoopModel& loop, const WallModel& wall) {
  return ClosedLoop(loop).growth(wall);
}

double largestStiffness(const LoopModel& loop, double damping) {
  const ClosedLoop closed(loop);
  double all_damping = loop.device.damping + damping;
  if (loop.hand) all_damping += loop.hand->damping + loop.hand->grip_damping;
  if (!(all_damping > 0.0)) return 0.0;
  const double delay = (0.5 + loop.delay) * loop.period + loop.device.lag;
  const double guess = all_damping / delay;
  return firstFailure(1e-6 * guess, 1e3 * guess, [&](double stiffness) {
    return closed.isStable({stiffness, damping});
  });
}

double largestDamping(const LoopModel& loop) {
  const ClosedLoop closed(loop);
  const double unit = closed.unitOfDamping();
  return firstFailure(1e-4 * unit, 1e4 * unit, [&](double damping) {
    return closed.isStable({0.0, damping});
  });
}

double missingDamping(const LoopModel& loop, const WallModel& wall) {
  const auto is_stable = [&](double more) {
    LoopModel damped = loop;
    damped.device.damping += more;
    return ClosedLoop(damped).isStable(wall);
  };
  if (is_stable(0.0)) return 0.0;
  double enough = std::max(loop.device.damping, 1e-6 * wall.stiffness * loop.period);
  while (enough < 1e9 && !is_stable(enough)) enough *= 2.0;
  if (!is_stable(enough)) return kInfinity;
  double less = 0.0;
  while (enough - less > 1e-9 * enough) {
    const double middle = 0.5 * (less + enough);
    (is_stable(middle) ? enough : less) = middle;
  }
  return enough;
}

double passiveStiffness(const LoopModel& loop, double damping) {
  using Complex = std::complex<double>;
  const std::vector<double> weights = velocityWeights(loop.velocity, loop.period);
  const double delay = loop.delay + loop.device.lag / loop.period;
  constexpr int kAngles = 4096;
  double most = kInfinity;
  for (int i = 1; i <= kAngles; ++i) {
    const double angle = std::numbers::pi * i / kAngles;
    Complex velocity = 0.0;
    for (std::size_t n = 0; n < weights.size(); ++n) {
      velocity += weights[n] * std::polar(1.0, -angle * static_cast<double>(n));
    }
    const Complex held = (1.0 - std::polar(1.0, -angle)) * std::polar(1.0, -angle * delay) *
                         (0.5 * loop.period / (1.0 - std::cos(angle)));
    const double spring = held.real();
    const double left = loop.device.damping - damping * (held * velocity).real();
    if (left < 0.0) return 0.0;
    if (spring > 0.0) most = std::min(most, left / spring);
  }
  return most;
}

double frictionStiffness(const DeviceModel& device) {
  return device.encoder > 0.0 ? 2.0 * device.friction / device.encoder : kInfinity;
}

double quietSpeed(const LoopModel& loop, const WallModel& wall) {
  const double missing = missingDamping(loop, wall);
  if (missing == 0.0) return kInfinity;
  return 4.0 * loop.device.friction / (std::numbers::pi * missing);
}

StabilityBudget budgetOf(const LoopModel& loop, double damping) {
  return {largestStiffness(loop, damping), passiveStiffness(loop, damping),
          frictionStiffness(loop.device)};
}

}  // namespace palpate::devices
