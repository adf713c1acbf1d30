#pragma once
/// A triangle in the form that the distance kernels need.

#include "palpate/core/math.h"

namespace palpate::vdb {

/// A triangle in its own frame, in voxels about a nearby origin. The squared distance of a point p
/// is (n . p + n0)^2 plus, unless p projects into the triangle, the least s^2 + o^2 over the sides:
/// s is the distance of p beyond the side's line, o the distance along it beyond the nearer end.
/// All constants belong to this triangle alone, so that one much larger than its neighborhood costs
/// no accuracy.
struct alignas(32) Facet {
  float out[3][4];    ///< in the plane, out of the triangle; and the offset: s = out . p + offset
  float along[3][3];  ///< along the sides; the first side is the longest
  float begin[3];     ///< of each side, along it
  float end[3];
  float normal[4];  ///< and the offset n0
};

/// `a`, `b`, `c` [voxels] seen from the origin that distances will be asked about. A triangle lower
/// than a billionth of its longest side becomes that side.
[[nodiscard]] Facet makeFacet(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

}  // namespace palpate::vdb
