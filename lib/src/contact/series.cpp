#include "palpate/contact/series.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr int kMostSteps = 32;
/// Relative to the force: how large the remaining sum of all forces on the point may be.
constexpr double kSettled = 1e-12;
/// The same, accepted where rounding of the walls' own points stops the iteration.
constexpr double kSettledAtLast = 1e-7;
/// Multiples of the stop's stiffness that are added to the derivative, one after the other, until a
/// step makes progress.
constexpr double kAdded[] = {0.0, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 16.0, 64.0, 256.0};
/// Relative to the energy: its rounding.
constexpr double kEnergyRounding = 1e-13;
/// Position of the first iterate, as a share of the way from the proxy to the hand; it is small
/// because the stop is not much stiffer than the stiffest wall.
constexpr double kFirst = 0.05;
/// Relative to the coordinates: a way to a wall that is shorter than this has no direction.
constexpr double kRounding = 1e-15;

struct Look {
  std::array<LocalProjection, SoftKinds::kMost> on{};  ///< by kind: the point on its walls
  std::array<double, SoftKinds::kMost> depth{};  ///< [m] by kind: depth at which its law is pressed
  Vec3 sum{0.0, 0.0, 0.0};                       ///< [N] the energy's gradient
  Mat3 rate{0.0};                                ///< [N/m] its derivative
  double energy = 0.0;                           ///< [J]
};

Look lookFrom(const Vec3& place, const Vec3& hand, double stop, SoftKinds& kinds,
              std::span<const LocalProjection> from) noexcept {
  Look out;
  const Vec3 off = place - hand;
  out.sum = stop * off;
  out.rate = Mat3(stop);
  out.energy = 0.5 * stop * glm::dot(off, off);
  const double size = std::max({std::fabs(place.x), std::fabs(place.y), std::fabs(place.z)});
  for (std::size_t m = 0; m < from.size(); ++m) {
    out.on[m] = kinds.nearest(m, from[m].at, place);
    const LocalProjection& on = out.on[m];
    const Vec3 way = place - on.at;
    const double give = glm::length(way);
    if (on.count == 0 || !(give > kRounding * size)) continue;
    const SharedWalls& law = kinds.law(m);
    const Vec3 u = way / give;
    const SoftWall soft = softWall(law, stop, give);
    out.depth[m] = soft.depth;
    out.sum += soft.force * u;
    // The law's energy minus the share of it that the stop would store.
    out.energy += law.energy(soft.depth) - 0.5 * soft.force * soft.force / stop;
    const Mat3 along = outer(u, u);
    Mat3 follows(0.0);
    for (int i = 0; i < 3; ++i) {
      Vec3 axis(0.0);
      axis[i] = 1.0;
      follows[i] = gradientByHand(axis, on.walls());
    }
    out.rate += soft.tangent * along + (soft.force / give) * (Mat3(1.0) - follows - along);
  }
  return out;
}

}  // namespace

SeriesForce seriesForce(const Vec3& proxy, const Vec3& hand, double stop,
                        SoftKinds& kinds) noexcept {
  const std::size_t count = std::min(kinds.count(), SoftKinds::kMost);
  std::array<LocalProjection, SoftKinds::kMost> from;
  for (LocalProjection& each : from) each.at = proxy;
  SeriesForce out;
  // Start close to the walls, where their curvature has little effect: if the steps started at the
  // hand they might lead anywhere.
  out.place = glm::mix(proxy, hand, kFirst);
  const double farthest = glm::length(hand - proxy);
  Look here = lookFrom(out.place, hand, stop, kinds, {from.data(), count});
  for (int i = 0; i < kMostSteps; ++i) {
    const double most =
        std::max(stop * glm::length(out.place - hand), 1e-3 * glm::length(here.sum));
    const double left = glm::length(here.sum);
    if (left <= kSettled * most || left == 0.0) {
      out.settled = true;
      break;
    }
    bool is_better = false;
    for (const double added : kAdded) {
      const Vec3 step = -(glm::inverse(here.rate + Mat3(added * stop)) * here.sum);
      // Where a wall bulges towards the point, the unmodified derivative may lead uphill, or far
      // away.
      if (!(glm::dot(step, here.sum) < 0.0) || glm::length(step) > farthest) continue;
      const Vec3 next = out.place + step;
      const Look there = lookFrom(next, hand, stop, kinds, {here.on.data(), count});
      const double rounding = kEnergyRounding * here.energy;
      const bool is_lower = there.energy < here.energy + 1e-4 * glm::dot(step, here.sum);
      const bool is_flatter =
          glm::length(there.sum) < left && there.energy <= here.energy + rounding;
      if (!is_lower && !is_flatter) continue;
      is_better = true;
      out.place = next;
      here = there;
      break;
    }
    if (!is_better) {
      out.settled = left <= kSettledAtLast * most;
      break;
    }
  }
  out.energy = here.energy;
  out.force = stop * (out.place - hand);
  for (std::size_t m = 0; m < count; ++m) {
    const SharedWalls& law = kinds.law(m);
    if (!(here.depth[m] > 0.0)) continue;
    const SoftKinds::Change change = kinds.change(m, here.on[m]);
    const double push = law.force(here.depth[m]);
    out.turn += push * change.by_proxy;
    if (change.by_press != Vec3(0.0)) {
      out.varies = true;
      out.by_press += push * change.by_press;
    }
    if (law.isEven()) continue;
    out.varies = true;
    out.rise += law.rise(here.depth[m]);
    out.by_press += law.byPress(here.depth[m]);
  }
  return out;
}

}  // namespace palpate
