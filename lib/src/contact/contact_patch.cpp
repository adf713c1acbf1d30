#include "palpate/contact/contact_patch.h"

#include <array>

namespace palpate {
namespace {

/// One of each two opposite places on a sphere, as far from each other as they get.
constexpr std::array kPlaces{
    std::array{-0.655094139, -0.674724839, 0.339997148},
    std::array{-0.916885915, -0.329714473, -0.224963521},
    std::array{0.404235338, 0.645974021, 0.647542551},
    std::array{-0.320858869, 0.830087922, -0.456074148},
    std::array{-0.305312669, -0.001060628, -0.952251568},
    std::array{-0.344378725, 0.827473950, 0.443497640},
    std::array{0.188121768, 0.981757247, 0.027620782},
    std::array{-0.780017524, 0.268043514, -0.565442603},
    std::array{-0.205755798, -0.490851930, 0.846598449},
    std::array{-0.341753223, 0.289716333, 0.894018558},
    std::array{0.858023757, 0.016417038, -0.513347557},
    std::array{0.846161091, -0.528011083, -0.072219836},
};

struct Radius {
  double value = 0.0;  // [m]
  double slope = 0.0;  // [-] by the depth
};

Radius radiusAt(double depth, double contrast) noexcept {
  const double point = 0.5 * contrast;
  const double more = depth - point;
  if (!(more > 0.0)) return {};
  // Quadratic at first, so that the force has no step.
  return {more * more / depth, more * (more + 2.0 * point) / (depth * depth)};
}

}  // namespace

double patchRadius(double depth, double contrast) noexcept {
  return radiusAt(depth, contrast).value;
}

PatchSample overPatch(const Parameter& map, const Vec3& middle, const Vec3& press,
                      double contrast) noexcept {
  PatchSample out;
  const double depth = glm::length(press);
  const Radius radius = radiusAt(depth, contrast);
  if (!(radius.value > 0.0)) {
    const MaterialMap::Sample s = map.sample(middle);
    return {s.value, s.gradient, Vec3(0.0)};
  }
  const Vec3 u = press / depth;
  double by_radius = 0.0;
  Vec3 by_direction(0.0);
  for (const std::array<double, 3>& each : kPlaces) {
    const Vec3 place(each[0], each[1], each[2]);
    const double along = glm::dot(u, place);
    const Vec3 off = place - along * u;
    for (const double side : {1.0, -1.0}) {
      const MaterialMap::Sample s = map.sample(middle + (side * radius.value) * off);
      out.value += s.value;
      out.by_place += s.gradient;
      by_radius += side * glm::dot(s.gradient, off);
      by_direction -= side * (along * s.gradient + glm::dot(s.gradient, u) * place);
    }
  }
  constexpr double kShare = 0.5 / static_cast<double>(kPlaces.size());
  out.value *= kShare;
  out.by_place *= kShare;
  by_direction *= kShare * radius.value / depth;
  out.by_press =
      by_direction - glm::dot(by_direction, u) * u + (kShare * by_radius * radius.slope) * u;
  return out;
}

}  // namespace palpate
