#pragma once
// Formulas for the place of the proxy. Each function gives every local minimum of |x - P| over the
// allowed side, for a HIP on the other side; for a free HIP the result is the HIP alone. If there
// is one minimum, the proxy must be there; if there are several, the previous proxy decides which.
// The formulas use nothing of lib: neither its fields nor its contact.

#include <vector>

#include "palpate/core/math.h"

namespace palpate::oracle {

using Minima = std::vector<Vec3>;

enum class Held { kOutside, kInside };  ///< where the proxy is held

/// The minimum nearest to `previous`, which must exist.
[[nodiscard]] Vec3 nearestTo(const Minima& minima, const Vec3& previous);

/// Ball, felt from outside or from its hollow inside; empty if P is at the center.
[[nodiscard]] Minima sphereMinima(const Vec3& p, const Vec3& center, double radius, Held held);

/// Half-space; the unit normal points to the side where the proxy is held.
[[nodiscard]] Minima planeMinima(const Vec3& p, const Vec3& point, const Vec3& normal);

/// Cylinder without ends, `axis` a unit vector.
[[nodiscard]] Minima cylinderMinima(const Vec3& p, const Vec3& center, const Vec3& axis,
                                    double radius, Held held);

/// Torus: circle of radius `major` about `axis` (unit), tube of radius `minor`.
[[nodiscard]] Minima torusMinima(const Vec3& p, const Vec3& center, const Vec3& axis, double major,
                                 double minor, Held held);

/// Box. Inside (a room): face, edge or corner. Outside: every face of the box is a minimum, however
/// deep P is; its edges and corners never are.
[[nodiscard]] Minima boxMinima(const Vec3& p, const Vec3& lo, const Vec3& hi, Held held);

/// Inside a cone with a flat base about `base` and its tip at base + height * axis (unit). One
/// minimum, because the cone is convex.
[[nodiscard]] Minima coneInside(const Vec3& p, const Vec3& base, const Vec3& axis, double radius,
                                double height);

struct Ball {
  Vec3 center;
  double radius;
};

/// Outside the union of two balls that overlap: on either ball, or in the crease.
[[nodiscard]] Minima twoBallUnionOutside(const Vec3& p, const Ball& a, const Ball& b);

/// Inside the intersection (the lens): on either cap, or on the rim. One minimum, because the lens
/// is convex.
[[nodiscard]] Minima lensInside(const Vec3& p, const Ball& a, const Ball& b);

/// Outside the lens: on either cap; its rim is not a minimum.
[[nodiscard]] Minima lensOutside(const Vec3& p, const Ball& a, const Ball& b);

/// The space between two planes through a line: n1.(x - point) >= 0 and n2.(x - point) >= 0, with
/// unit normals. A groove of opening angle A has n1.n2 = -cos A. One minimum.
[[nodiscard]] Minima grooveMinima(const Vec3& p, const Vec3& point, const Vec3& n1, const Vec3& n2);

/// The space around a wedge: n1.(x - point) >= 0 or n2.(x - point) >= 0.
[[nodiscard]] Minima foldMinima(const Vec3& p, const Vec3& point, const Vec3& n1, const Vec3& n2);

/// The closest point of the surface of an ellipsoid about the origin with semi-axes `radii` along
/// x, y, z, computed in long double to its rounding. It is the global minimum, which is the proxy
/// as long as P is nearer to the surface than to the medial axis. If several points are equally
/// close: one of them.
[[nodiscard]] Vec3 closestOnEllipsoid(const Vec3& p, const Vec3& radii);

}  // namespace palpate::oracle
