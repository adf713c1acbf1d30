#include "start_point.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr int kDirections = 200;
constexpr int kSteps = 96;
constexpr int kHalvings = 48;

/// Evenly spread over the sphere (Fibonacci lattice).
Vec3 direction(int i) noexcept {
  const double golden = 2.399963229728653;  // [rad] pi (3 - sqrt 5)
  const double z = 1.0 - (2.0 * i + 1.0) / kDirections;
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(golden * i), r * std::sin(golden * i), z};
}

}  // namespace

Vec3 startPoint(const Scene& scene, CellWalker& probe, const Vec3& hip) noexcept {
  const RegionId wanted = scene.startRegion();
  const auto lies_there = [&](const Vec3& p) {
    probe.place(p);
    return probe.region() == wanted;
  };
  if (lies_there(hip)) return hip;

  const Box3 box = scene.bounds();
  const double reach =
      box.isBounded() ? glm::length(box.size()) + box.distanceTo(hip) : 1.0;  // [m]
  // Along each line: how far to the region, in steps that grow so that near walls are found finely.
  double best = kInfinity;
  Vec3 found = hip;
  for (int i = 0; i < kDirections; ++i) {
    const Vec3 u = direction(i);
    double last = 0.0;
    for (int k = 1; k <= kSteps; ++k) {
      const double share = static_cast<double>(k) / kSteps;
      const double t = reach * share * share * share;
      if (t >= best) break;
      if (!lies_there(hip + t * u)) {
        last = t;
        continue;
      }
      double outside = last;
      double inside = t;
      for (int h = 0; h < kHalvings; ++h) {
        const double middle = 0.5 * (outside + inside);
        (lies_there(hip + middle * u) ? inside : outside) = middle;
      }
      best = inside;
      found = hip + inside * u;
      break;
    }
  }
  if (best < kInfinity) return found;
  const Region& region = scene.regions()[wanted];
  return region.has_seed ? region.seed : hip;
}

}  // namespace palpate
