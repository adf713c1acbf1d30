#include "start_point.h"

#include <algorithm>
#include <cmath>

#include "palpate/interior/partition.h"

namespace palpate {
namespace {

// Together these bound the work to about 1500 evaluations.
constexpr std::size_t kMostLeaves = 64;
constexpr int kFootSteps = 12;
constexpr int kDirections = 48;
constexpr int kSteps = 20;
/// How far inside the region a foot point is placed, as a share of the feature size.
constexpr double kWithin = 1e-6;

/// Element `i` of directions that are evenly spread over the sphere (Fibonacci lattice).
Vec3 direction(int i) noexcept {
  const double golden = 2.399963229728653;  // [rad] pi (3 - sqrt 5)
  const double z = 1.0 - (2.0 * i + 1.0) / kDirections;
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(golden * i), r * std::sin(golden * i), z};
}

/// Follows the field's gradient from `p` to its surface; false if it does not get there.
bool toSurface(const Leaf& leaf, Vec3& p, Vec3& normal) noexcept {
  for (int i = 0; i < kFootSteps; ++i) {
    const FieldSample s = leaf.field->sample(p);
    const double square = glm::dot(s.gradient, s.gradient);
    if (!s.in_band || !(square > 0.0)) return false;
    normal = s.gradient / std::sqrt(square);
    if (std::fabs(s.value) <= 1e-3 * kWithin * leaf.feature * leaf.lipschitz) return true;
    p -= (s.value / square) * s.gradient;
    if (!isFinite(p)) return false;
  }
  return false;
}

}  // namespace

Vec3 startPoint(const Scene& scene, CellWalker& probe, const Vec3& hip) noexcept {
  const RegionId wanted = scene.startRegion();
  const auto lies_there = [&](const Vec3& p) {
    probe.place(p);
    return probe.region() == wanted;
  };
  if (lies_there(hip)) return hip;

  double best = kInfinity;
  Vec3 found = hip;
  const auto consider = [&](const Vec3& p) {
    const double distance = glm::length(p - hip);
    if (distance < best && lies_there(p)) {
      best = distance;
      found = p;
    }
  };
  // The nearest point of a simple region is the foot on one of its faces.
  const std::span<const Leaf> leaves = scene.partition().leaves();
  for (std::size_t i = 0; i < std::min(leaves.size(), kMostLeaves); ++i) {
    Vec3 foot = hip;
    Vec3 normal(0.0);
    if (!toSurface(leaves[i], foot, normal)) continue;
    const double within = kWithin * leaves[i].feature;
    consider(foot + within * normal);
    consider(foot - within * normal);
  }
  if (best < kInfinity) return found;

  // For edges, corners and grids far outside their band: search along lines, in growing steps.
  const Box3 box = scene.bounds();
  const double reach =
      box.isBounded() ? glm::length(box.size()) + box.distanceTo(hip) : 1.0;  // [m]
  for (int i = 0; i < kDirections; ++i) {
    const Vec3 u = direction(i);
    for (int k = 1; k <= kSteps; ++k) {
      const double share = static_cast<double>(k) / kSteps;
      const double t = reach * share * share * share;
      if (t >= best) break;
      consider(hip + t * u);
    }
  }
  const Region& region = scene.regions()[wanted];
  if (region.has_seed) consider(region.seed);
  return found;
}

}  // namespace palpate
