#pragma once
/// The local problem of a proxy, solved exactly: the smallest |step - wish| that respects a set of
/// planes; and the same in the metric given by the walls' curvature. Real-time safe.

#include <array>
#include <span>

#include "palpate/core/math.h"

namespace palpate {

/// A closed wall near the proxy, linearized: steps p with normal . p >= -gap are allowed.
struct Plane {
  Vec3 normal{0.0, 0.0, 1.0};  ///< [-] unit, towards the side the proxy is on
  double gap = 0.0;            ///< [m] distance left to the wall; negative: already beyond
};

struct PlaneSolution {
  Vec3 step{0.0, 0.0, 0.0};            ///< [m]
  int count = 0;                       ///< number of planes that hold the step, at most 3
  std::array<int, 3> plane{};          ///< their indices
  std::array<double, 3> multiplier{};  ///< [m] wish + sum multiplier * normal = step; all > 0
};

/// The most planes of one problem.
inline constexpr std::size_t kMaxPlanes = 48;

/// The unique minimum (the problem is convex). The planes are added one after the other, and
/// whenever the step violates the new one, the problem is solved again on that plane (Seidel,
/// "Small-dimensional linear programming and convex hulls made easy", 1991; here with |step - wish|
/// as the objective). This is exact, and takes a time proportional to the number of planes. If
/// rounding makes planes contradict each other, the result violates them as little as possible.
[[nodiscard]] PlaneSolution closestStep(const Vec3& wish, std::span<const Plane> planes) noexcept;

/// The Newton step: min p.B p / 2 - wish.p within the planes that hold `first`, the solution of
/// closestStep(), subject to all others, where B = I - bend in their tangent space. Eigenvalues of
/// B are replaced by their magnitudes, and raised to at least `least`, so that the step comes
/// closer.
struct CurvedStep {
  Vec3 step{0.0, 0.0, 0.0};  ///< [m]
  double lowest = 1.0;       ///< [-] the smallest eigenvalue of B along the planes
  Vec3 downhill{0.0, 0.0,
                0.0};  ///< [-] its unit eigenvector; zero where the planes leave no free motion
};
[[nodiscard]] CurvedStep curvedStep(const Vec3& wish, std::span<const Plane> planes,
                                    const PlaneSolution& first, const Mat3& bend,
                                    double least) noexcept;

/// A unit vector perpendicular to `n` (unit), and the one that completes a right-handed frame with
/// both (Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
void tangentsOf(const Vec3& n, Vec3& t1, Vec3& t2) noexcept;

}  // namespace palpate
