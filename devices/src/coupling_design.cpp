#include "palpate/devices/coupling_design.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palpate/core/error.h"

namespace palpate::devices {
namespace {

void checkLoop(const LoopModel& loop) {
  check(loop.device);
  if (!(loop.period > 0.0) || !std::isfinite(loop.period) || loop.delay < 0) {
    throw Error(ErrorKind::kUsage,
                {"loop.period", "a loop needs a period of more than 0 s and a delay of 0 or more"});
  }
  if (loop.device.damping > 0.0) return;
  throw Error(ErrorKind::kUsage,
              {"coupling.device",
               "no coupling is stable with this device: it has no damping, so it takes no energy"});
}

/// [s/kg] The margin between the coupling and what the device can hold, at the worst frequency;
/// negative: too stiff.
double marginOf(const LoopModel& loop, double ticks, double stiffness, double damping) {
  constexpr int kSteps = 400;
  double least = kInfinity;
  for (int i = 1; i <= kSteps; ++i) {
    // Steps are finer at small angles: with a delay the worst frequency is there.
    const double share = static_cast<double>(i) / kSteps;
    const double angle = std::numbers::pi * share * share;
    const double real = damping + 0.5 * stiffness * loop.period;
    const double imaginary = 0.5 * stiffness * loop.period / std::tan(0.5 * angle);
    const double asked = (1.0 - std::cos(ticks * angle)) / (2.0 * loop.device.damping);
    const double norm = real * real + imaginary * imaginary;
    if (norm > 0.0) least = std::min(least, real / norm - asked);
  }
  return least;
}

}  // namespace

double stiffestForAnyScene(const LoopModel& loop, double damping) {
  checkLoop(loop);
  const double ticks = 1.0 + loop.delay + std::ceil(loop.device.lag / loop.period);
  const double plain = 2.0 * loop.device.damping / (loop.period * ticks * ticks);
  if (damping == 0.0) return plain;
  double low = 0.0;
  double high = 2.0 * loop.device.damping / loop.period;
  if (marginOf(loop, ticks, high, damping) >= 0.0) return high;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (marginOf(loop, ticks, middle, damping) >= 0.0 ? low : high) = middle;
  }
  return low;
}

double stiffestForSprings(const LoopModel& loop, double damping) {
  checkLoop(loop);
  const double late = (0.5 + loop.delay) * loop.period + loop.device.lag;
  return damping > loop.device.damping ? 2.0 * std::sqrt(loop.device.damping * damping) / late
                                       : (loop.device.damping + damping) / late;
}

CouplingSettings couplingForAnyScene(const LoopModel& loop) {
  CouplingSettings best{stiffestForAnyScene(loop, 0.0), 0.0};
  constexpr int kSteps = 25;
  for (int i = 1; i < kSteps; ++i) {
    const double damping = loop.device.damping * i / kSteps;
    const double stiffness = stiffestForAnyScene(loop, damping);
    if (stiffness > best.stiffness) best = {stiffness, damping};
  }
  return best;
}

CouplingSettings couplingForSprings(const LoopModel& loop) {
  checkLoop(loop);
  const double damping =
      std::max(loop.device.damping, kCouplingDampingShare * loop.device.mass / loop.period);
  return {kCouplingMargin * stiffestForSprings(loop, damping), damping};
}

}  // namespace palpate::devices
