#pragma once
// Where the proxy is, by formula. Each function gives every local minimum of |x - P| over the
// allowed side, for a HIP that is on the other side; a free HIP gives itself, and nothing else.
// Where there is one, the proxy must be there; where there are several, the previous proxy decides
// which. None is made with lib: neither its fields nor its contact.

#include <vector>

#include "palpate/core/math.h"

namespace palpate::oracle {

using Minima = std::vector<Vec3>;

enum class Held { kOutside, kInside };  ///< where the proxy is held

/// The minimum nearest to `previous`, which must exist.
[[nodiscard]] Vec3 nearestTo(const Minima& minima, const Vec3& previous);

/// Ball. From outside and from the hollow inside; nothing for P at the center.
[[nodiscard]] Minima sphereMinima(const Vec3& p, const Vec3& center, double radius, Held held);

/// Half-space; the normal (unit) points to where the proxy is held.
[[nodiscard]] Minima planeMinima(const Vec3& p, const Vec3& point, const Vec3& normal);

/// Cylinder without ends, `axis` a unit vector.
[[nodiscard]] Minima cylinderMinima(const Vec3& p, const Vec3& center, const Vec3& axis,
                                    double radius, Held held);

/// Torus: circle of radius `major` about `axis` (unit), tube of radius `minor`.
[[nodiscard]] Minima torusMinima(const Vec3& p, const Vec3& center, const Vec3& axis, double major,
                                 double minor, Held held);

/// Box. Inside (a room): face, edge or corner. Outside: every face of the box, deep or not, is a
/// minimum; its edges and corners never are.
[[nodiscard]] Minima boxMinima(const Vec3& p, const Vec3& lo, const Vec3& hi, Held held);

/// Inside a cone with a flat base about `base`, tip at base + height * axis (unit). One minimum, it
/// is convex.
[[nodiscard]] Minima coneInside(const Vec3& p, const Vec3& base, const Vec3& axis, double radius,
                                double height);

struct Ball {
  Vec3 center;
  double radius;
};

/// Outside the union of two balls that overlap: on either ball, or in the crease.
[[nodiscard]] Minima twoBallUnionOutside(const Vec3& p, const Ball& a, const Ball& b);

/// Inside the intersection (the lens): on either cap, or on the rim. One minimum, the lens is
/// convex.
[[nodiscard]] Minima lensInside(const Vec3& p, const Ball& a, const Ball& b);

/// Outside the lens: on either cap; its rim is not a minimum.
[[nodiscard]] Minima lensOutside(const Vec3& p, const Ball& a, const Ball& b);

/// The room between two planes through a line: x = P with n1.x >= 0 and n2.x >= 0, unit normals,
/// planes through `point`. A groove of opening angle A has n1.n2 = -cos A. One minimum.
[[nodiscard]] Minima grooveMinima(const Vec3& p, const Vec3& point, const Vec3& n1, const Vec3& n2);

/// The room around a wedge: n1.x >= 0 or n2.x >= 0.
[[nodiscard]] Minima foldMinima(const Vec3& p, const Vec3& point, const Vec3& n1, const Vec3& n2);

/// The closest point of an ellipsoid's surface with semi-axes `radii` along x, y, z about the
/// origin, in long double to its rounding. The global one, which is the proxy as long as P is
/// nearer to the surface than the surface's medial axis. For points with equal distances: one of
/// them.
[[nodiscard]] Vec3 closestOnEllipsoid(const Vec3& p, const Vec3& radii);

}  // namespace palpate::oracle
