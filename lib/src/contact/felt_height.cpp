#include "palpate/contact/felt_height.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

/// Node spacing over the radius: the spline reaches one and a half spacings to each side.
constexpr double kSpacing = 2.0 / 3.0;
/// [nodes] Distances are clamped here: no node that matters is farther from the surface.
constexpr double kFarthest = 3.0;

struct Weights {
  std::array<double, 3> value{};
  std::array<double, 3> slope{};
};

/// Weights of the quadratic B-spline at `t`, -1/2 to 1/2 from the middle node.
Weights weightsAt(double t) noexcept {
  return {{0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)},
          {t - 0.5, -2.0 * t, t + 0.5}};
}

double distanceAt(const Field& field, const Vec3& p, double most) noexcept {
  double distance = 0.0;
  if (field.metric() == Metric::kImplicit) {
    const FieldSample s = field.sample(p);
    const double slope = glm::length(s.gradient);
    distance = slope > 0.0 ? s.value / slope : s.value;
  } else {
    distance = field.value(p);
  }
  return std::isfinite(distance) ? std::clamp(distance, -most, most) : 0.0;
}

}  // namespace

FeltHeight textureHeight(const Texture& texture, const Vec3& p) noexcept {
  FeltHeight out;
  const MaterialMap::Sample amplitude = texture.amplitude.sample(p);
  if (!(amplitude.value > 0.0)) return out;
  const double k = 2.0 * std::numbers::pi / texture.wavelength;
  const Vec3 phase = p * k;
  const double wave = (std::sin(phase.x) + std::sin(phase.y) + std::sin(phase.z)) / 3.0;
  out.value = amplitude.value * wave;
  out.gradient =
      (amplitude.value * k / 3.0) * Vec3(std::cos(phase.x), std::cos(phase.y), std::cos(phase.z)) +
      wave * amplitude.gradient;
  return out;
}

double textureReach(const Texture& texture) noexcept {
  const double amplitude = texture.amplitude.range().most;
  if (!(amplitude > 0.0)) return kInfinity;
  // Sideways a bump acts as a spring of stiffness * amplitude * k^2 / 3 times the effective depth,
  // at most one and a half times this reach. So it is at most half as stiff as the wall.
  const double k = 2.0 * std::numbers::pi / texture.wavelength;
  return std::max(2.0 * amplitude, 1.0 / (amplitude * k * k));
}

FeltHeight SmoothedField::at(const Field& field, double radius, const Vec3& p) noexcept {
  const double spacing = kSpacing * radius;
  std::array<double, 3> node{};
  std::array<Weights, 3> weights;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const double place = p[i] / spacing;
    node[axis] = std::round(place);
    weights[axis] = weightsAt(place - node[axis]);
  }
  if (field_ != &field || spacing_ != spacing || node_ != node) {
    node_ = node;
    look(field, spacing);
  }
  FeltHeight out;
  std::size_t n = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double d = distance_[n++];
        const double x = weights[0].value[i];
        const double y = weights[1].value[j];
        const double z = weights[2].value[k];
        out.value += x * y * z * d;
        out.gradient += d * Vec3(weights[0].slope[i] * y * z, x * weights[1].slope[j] * z,
                                 x * y * weights[2].slope[k]);
      }
    }
  }
  out.gradient /= spacing;
  return out;
}

void SmoothedField::look(const Field& field, double spacing) noexcept {
  field_ = &field;
  spacing_ = spacing;
  std::size_t n = 0;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      for (int k = -1; k <= 1; ++k) {
        const Vec3 p(node_[0] + i, node_[1] + j, node_[2] + k);
        distance_[n++] = distanceAt(field, spacing * p, kFarthest * spacing);
      }
    }
  }
}

}  // namespace palpate
