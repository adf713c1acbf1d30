#include "fields/vector.h"

#include <algorithm>

namespace palpate::fields {

Polar polarScaled(const Vec3& v, const Vec3& fallback) noexcept {
  if (std::isnan(v.x) || std::isnan(v.y) || std::isnan(v.z)) return {glm::dot(v, v), v};
  const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  if (largest == 0.0) return {0.0, fallback};
  if (std::isinf(largest)) return {largest, fallback};
  // Divide instead of multiplying by 1 / largest, which overflows for the smallest denormals.
  const Vec3 scaled(v.x / largest, v.y / largest, v.z / largest);
  const double length = std::sqrt(glm::dot(scaled, scaled));
  return {largest * length, scaled * (1.0 / length)};
}

double lengthScaled(const Vec3& v) noexcept { return polarScaled(v, Vec3(1.0, 0.0, 0.0)).length; }

Vec3 perpendicularTo(const Vec3& n) noexcept {
  // The axis along which n has its smallest component; it is at least 54 degrees away from n.
  const Vec3 size = glm::abs(n);
  Vec3 axis(1.0, 0.0, 0.0);
  if (size.y < size.x && size.y <= size.z) axis = Vec3(0.0, 1.0, 0.0);
  if (size.z < size.x && size.z < size.y) axis = Vec3(0.0, 0.0, 1.0);
  return glm::normalize(axis - n * glm::dot(axis, n));
}

}  // namespace palpate::fields
