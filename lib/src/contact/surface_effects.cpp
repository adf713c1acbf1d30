#include "palpate/contact/surface_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {

double textureHeight(const Texture& texture, const Vec3& p, double depth) noexcept {
  const double amplitude = texture.amplitude.at(p);
  if (amplitude <= 0.0) return 0.0;
  const Vec3 phase = p * (2.0 * std::numbers::pi / texture.wavelength);
  const double wave = (std::sin(phase.x) + std::sin(phase.y) + std::sin(phase.z)) / 3.0;
  const double most = std::max(0.0, 0.5 * depth);
  return std::clamp(amplitude * wave, -most, most);
}

Vec3 shadedNormal(const Field& field, double side, const Vec3& p, const Vec3& normal,
                  double radius) noexcept {
  const Vec3 other = std::fabs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  const Vec3 t1 = glm::normalize(glm::cross(normal, other));
  const Vec3 t2 = glm::cross(normal, t1);
  Vec3 sum(0.0);
  for (const Vec3& axis : {normal, t1, t2}) {
    const FieldSample ahead = field.sample(p + radius * axis);
    const FieldSample behind = field.sample(p - radius * axis);
    if (!ahead.in_band || !behind.in_band) return normal;
    sum += side * (ahead.value - behind.value) * axis;
  }
  return unitOr(sum, normal);
}

}  // namespace palpate
