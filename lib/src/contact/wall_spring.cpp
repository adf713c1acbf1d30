#include "palpate/contact/wall_spring.h"

#include <cmath>

namespace palpate {

double WallSpring::growth(double depth) const noexcept {
  if (exponent == 1.0) return 1.0;
  if (depth <= 0.0) return 0.0;
  const double share = depth / reference;
  return exponent == 1.5 ? std::sqrt(share) : std::pow(share, exponent - 1.0);
}

double WallSpring::secant(double depth) const noexcept {
  return isStraight() ? stiffness : stiffness * growth(depth) + stiffening * depth;
}

double WallSpring::energyPerStiffness(double depth) const noexcept {
  if (depth <= 0.0) return 0.0;
  return growth(depth) * depth * depth / (exponent + 1.0);
}

}  // namespace palpate
