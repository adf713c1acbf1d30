#pragma once
/// A triangle as the distance kernels want it.

#include "palpate/core/math.h"

namespace palpate::vdb {

/// A triangle in its own frame, in voxels about a nearby origin. The square of the distance of a
/// point p is (n . p + n0)^2, and, unless p is over the triangle, the least over the sides of s^2 +
/// o^2: s is how far p is out of the side's line, o how far along it beyond an end. Everything
/// follows from constants of its own, so that a triangle much larger than the neighborhood costs no
/// accuracy.
struct alignas(32) Facet {
  float out[3][4];    ///< in the plane, out of the triangle; and the offset: s = out . p + offset
  float along[3][3];  ///< along the sides; the first side is the longest
  float begin[3];     ///< of each side, along it
  float end[3];
  float normal[4];  ///< and the offset
};

/// `a`, `b`, `c` [voxels] from the origin that the facet will be asked about. A triangle lower than
/// a billionth of its longest side becomes that side.
[[nodiscard]] Facet makeFacet(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

}  // namespace palpate::vdb
