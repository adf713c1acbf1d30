#pragma once
/// The local problem of a proxy: the smallest |step - wish| that respects a few planes, solved exactly.

#include <array>
#include <span>

#include "palpate/core/math.h"

namespace palpate {

/// A closed wall near the proxy, linearised: steps p with normal . p >= -gap are allowed.
struct Plane {
  Vec3 normal{0.0, 0.0, 1.0};  ///< [-] unit, towards the side the proxy is on
  double gap = 0.0;            ///< [m] distance left to the wall; negative: already beyond
};

struct PlaneSolution {
  Vec3 step{0.0, 0.0, 0.0};            ///< [m]
  int count = 0;                       ///< planes that hold the step, at most 3
  std::array<int, 3> plane{};          ///< their indices
  std::array<double, 3> multiplier{};  ///< [m] wish + sum multiplier * normal = step; all > 0
};

inline constexpr std::size_t kMaxPlanes = 8;

/// Tries every set of up to three of the first kMaxPlanes planes: the set whose solution is feasible
/// with non-negative multipliers is the minimum, since the problem is convex. Where no set is (planes that
/// exclude each other, by rounding), the step is zero and the deepest plane holds it.
[[nodiscard]] PlaneSolution closestStep(const Vec3& wish, std::span<const Plane> planes) noexcept;

}  // namespace palpate
