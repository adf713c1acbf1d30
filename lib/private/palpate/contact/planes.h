#pragma once
/// The local problem of a proxy: the smallest |step - wish| that respects planes, solved exactly,
/// and the same in the metric of the walls' curvature. Real-time safe.

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
  int count = 0;                       ///< planes that hold the step, at most 3
  std::array<int, 3> plane{};          ///< their indices
  std::array<double, 3> multiplier{};  ///< [m] wish + sum multiplier * normal = step; all > 0
};

/// Planes that one problem may have; the solver takes no more.
inline constexpr std::size_t kMaxPlanes = 48;

/// The one minimum (the problem is convex). Each plane is added in turn and, where the step breaks
/// it, the problem is solved anew on it (Seidel, "Small-dimensional linear programming and convex
/// hulls made easy", 1991; here with |step - wish| as the aim): exact, linear in the number of
/// planes for a fixed number that hold. Planes that exclude each other by rounding give the step
/// that breaks them least.
[[nodiscard]] PlaneSolution closestStep(const Vec3& wish, std::span<const Plane> planes) noexcept;

/// The Newton step: min p.B p / 2 - wish.p in the planes that hold `first`, the solution of
/// closestStep(), with respect to all others, where B = I - bend in their tangent space.
/// Eigenvalues of B count by their magnitude, and as `least` at least, so that the step comes
/// closer.
struct CurvedStep {
  Vec3 step{0.0, 0.0, 0.0};  ///< [m]
  double lowest = 1.0;       ///< [-] the smallest eigenvalue of B along the planes
  Vec3 downhill{0.0, 0.0,
                0.0};  ///< [-] its direction, unit; zero where no motion along them is free
};
[[nodiscard]] CurvedStep curvedStep(const Vec3& wish, std::span<const Plane> planes,
                                    const PlaneSolution& first, const Mat3& bend,
                                    double least) noexcept;

/// A unit vector across `n` (unit), and the one that completes them to a right-handed frame (Duff
/// et al., "Building an Orthonormal Basis, Revisited", 2017).
void tangentsOf(const Vec3& n, Vec3& t1, Vec3& t2) noexcept;

}  // namespace palpate
