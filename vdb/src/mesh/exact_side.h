#pragma once
/// The side of a line or a plane on which a point lies: the exact sign for the doubles as given.

#include "palpate/core/math.h"

namespace palpate::vdb {

/// Sign of the volume of the tetrahedron a, b, c, d: 1 if a, b, c are clockwise seen from d, -1 if
/// counterclockwise, 0 if the four lie in one plane. Exact unless products of three coordinates
/// exceed the range of doubles.
[[nodiscard]] int sideOfPlane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;

/// The same for a, b, c seen along `axis` (0: x, 1: y, 2: z): 1 if they are counterclockwise, 0 if
/// in line.
[[nodiscard]] int sideOfLine(const Vec3& a, const Vec3& b, const Vec3& c, int axis) noexcept;

}  // namespace palpate::vdb
