#include "palpate/contact/wall_law.h"

#include <algorithm>
#include <cmath>

#include "soft_wall.h"

namespace palpate {
namespace {

/// [N] The integral of the secant stiffness over the depth.
double secantIntegral(const WallSpring& s, double depth) noexcept {
  if (!(depth > 0.0)) return 0.0;
  const double straight =
      s.exponent == 1.0
          ? s.stiffness * depth
          : s.stiffness * s.reference * std::pow(depth / s.reference, s.exponent) / s.exponent;
  return straight + 0.5 * s.stiffening * depth * depth;
}

/// [J] The integral of the secant stiffness times the depth: the spring's own energy.
double springEnergy(const WallSpring& s, double depth) noexcept {
  return s.stiffness * s.energyPerStiffness(depth) +
         s.stiffening * WallSpring::energyPerStiffening(depth);
}

double springTangent(const WallSpring& s, double depth) noexcept {
  if (s.exponent == 1.0) return s.stiffness + 2.0 * s.stiffening * depth;
  const double power =
      depth > 0.0 ? s.stiffness * std::pow(depth / s.reference, s.exponent - 1.0) : 0.0;
  return s.exponent * power + 2.0 * s.stiffening * depth;
}

/// The derivative of the secant stiffness by the depth.
double secantTangent(const WallSpring& s, double depth) noexcept {
  if (s.exponent == 1.0) return s.stiffening;
  return (s.exponent - 1.0) * s.stiffness * std::pow(depth / s.reference, s.exponent - 1.0) /
             depth +
         s.stiffening;
}

}  // namespace

double WallLaw::fading(double depth) const noexcept {
  if (depth <= reach) return 1.0;
  return depth < 2.0 * reach ? 2.0 - depth / reach : 0.0;
}

double WallLaw::shown(double depth) const noexcept {
  if (height == 0.0) return 0.0;
  const double most = std::max(0.0, held * depth);
  return std::clamp(height, -most, most) * fading(depth);
}

double WallLaw::tangent(double depth) const noexcept {
  const double own = springTangent(spring, depth);
  if (height == 0.0 || !(depth > 0.0)) return own;
  const double c = shown(depth);
  double rate = 0.0;
  if (held * depth < std::fabs(height)) {
    rate = std::copysign(held, height);
  } else if (depth > reach && depth < 2.0 * reach) {
    rate = -height / reach;
  }
  return own + secantTangent(spring, depth) * c + spring.secant(depth) * rate;
}

double WallLaw::energyPerHeight(double depth) const noexcept {
  const double from = std::fabs(height) / held;
  if (!(depth > from)) return 0.0;
  double all = 0.0;
  if (depth <= reach) {
    all = secantIntegral(spring, depth);
  } else {
    const double end = std::min(depth, 2.0 * reach);
    all = 2.0 * secantIntegral(spring, end) - secantIntegral(spring, reach) -
          (springEnergy(spring, end) - springEnergy(spring, reach)) / reach;
  }
  return all - secantIntegral(spring, from);
}

double WallLaw::energy(double depth) const noexcept {
  if (!(depth > 0.0)) return 0.0;
  const double own = springEnergy(spring, depth);
  if (height == 0.0) return own;
  const double from = std::min(depth, std::fabs(height) / held);
  return own + std::copysign(held, height) * springEnergy(spring, from) +
         height * energyPerHeight(depth);
}

double WallLaw::energyPerStiffness(double depth) const noexcept {
  if (height == 0.0) return spring.energyPerStiffness(depth);
  WallLaw unit = *this;
  unit.spring.stiffness = 1.0;
  unit.spring.stiffening = 0.0;
  return unit.energy(depth);
}

double WallLaw::energyPerStiffening(double depth) const noexcept {
  if (height == 0.0) return WallSpring::energyPerStiffening(depth);
  WallLaw unit = *this;
  unit.spring.stiffness = 0.0;
  unit.spring.stiffening = 1.0;
  return unit.energy(depth);
}

SoftWall softWall(const WallLaw& law, double stop, double give) noexcept {
  return softWallOf(law, stop, give);
}

}  // namespace palpate
