#pragma once
/// The checks on a wall that are made before a step along it is trusted (proxy_step.cpp,
/// proxy_glide.cpp, proxy_crease.cpp).

#include <algorithm>
#include <cmath>

#include "near_walls.h"
#include "solver_limits.h"

namespace palpate {

/// Whether the facet belongs to a wall of one leaf that holds the proxy here. Such a wall may open
/// once the proxy rests.
[[nodiscard]] inline bool isWallHere(const Leaf& leaf, const Facet& facet) noexcept {
  return !leaf.is_between && facet.isClosed() && facet.kind != Facet::Kind::kInternal;
}

/// Whether a wall with this facet stays the same while the proxy glides on it: nothing opens.
[[nodiscard]] inline bool isPlainWall(const Leaf& leaf, const Facet& facet) noexcept {
  return isWallHere(leaf, facet) && !facet.opens && !facet.varies;
}

/// Whether the step to `there` landed on the wall that `here` and its curvature `bend` [1/m]
/// predict; it landed `off` [m] beside the predicted place. If it landed on a different wall, there
/// is a crease on the way.
[[nodiscard]] inline bool landedAsPromised(const WallThere& here, const WallThere& there,
                                           double bend, double length, double off) noexcept {
  const Vec3 turned = there.normal - here.normal;
  const double bent = bend * length;
  const double explained = 2.0 * bent + limits::kFirmTurn;
  return glm::dot(turned, turned) <= explained * explained &&
         std::fabs(off) <= bent * length + limits::kNoise * here.tolerance;
}

/// Whether a way of `length` [m], over which the normal may turn by at most `turn` [rad], is short
/// enough on a wall with the curvature `bend` [1/m].
[[nodiscard]] inline bool isShortFor(const Leaf& leaf, double bend, double length,
                                     double turn = limits::kTurnsMore) noexcept {
  return bend * length <= turn &&
         (leaf.is_flat || length <= limits::kShareOfFeature * leaf.feature);
}

/// [m] By how much a chord of `length` [m] may dip into a wall with the curvature `bend` [1/m].
[[nodiscard]] inline double dipOfChord(double bend, double length) noexcept {
  return std::min(limits::kDipByBend * bend * length, limits::kDipByLength) * length;
}

/// Whether the chord from `x` to `y` [m] stays on the free side of `field`, except for the dip that
/// the curvature `bend` [1/m] explains. The distance towards the free side is S times `scale`.
[[nodiscard]] inline bool keepsOnChord(const Field& field, const Vec3& x, const Vec3& y,
                                       double scale, double bend, double tolerance) noexcept {
  const double length = glm::length(y - x);
  const double turn = bend * length;
  if (turn <= limits::kTurnsMuch) return true;
  const double dip = dipOfChord(bend, length);
  for (const double share : {0.5, 0.25, 0.75}) {
    if (share != 0.5 && turn <= limits::kTurnsMore) break;
    if (scale * field.value(x + share * (y - x)) < -(dip + tolerance)) return false;
  }
  return true;
}

}  // namespace palpate
