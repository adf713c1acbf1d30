#include "bake/facet.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::vdb {
namespace {

/// [voxels] Up to this distance and this length of a side, floats are accurate enough.
constexpr float kNear = 16.0F;
constexpr float kShort = 6.0F;
/// Above this ratio of height to length, floats give the plane accurately enough.
constexpr float kStout = 0.01F;

template <typename Vector>
Vector normalizedOr(const Vector& v, const Vector& otherwise) noexcept {
  using Scalar = typename Vector::value_type;
  const Scalar length = std::sqrt(glm::dot(v, v));
  return length > Scalar(0) ? v * (Scalar(1) / length) : otherwise;
}

template <typename Vector>
Vector anyAcross(const Vector& v) noexcept {
  const Vector axis = std::abs(v.x) < 0.6F ? Vector(1, 0, 0) : Vector(0, 1, 0);
  return normalizedOr(glm::cross(v, axis), axis);
}

/// The triangle's frame. Returns false, and sets nothing, if the triangle is lower than `least`
/// times its longest side, unless `any`.
template <typename Vector>
bool makeFacetOf(std::array<Vector, 3> corners, typename Vector::value_type least, bool any,
                 Facet& facet) noexcept {
  using Scalar = typename Vector::value_type;
  const auto square = [](const Vector& v) { return glm::dot(v, v); };
  const std::array<Scalar, 3> squares{square(corners[1] - corners[0]),
                                      square(corners[2] - corners[1]),
                                      square(corners[0] - corners[2])};
  const Scalar longest = std::max({squares[0], squares[1], squares[2]});
  if (longest == squares[1]) {
    corners = {corners[1], corners[2], corners[0]};
  } else if (longest == squares[2]) {
    corners = {corners[2], corners[0], corners[1]};
  }
  const Vector cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const Scalar area = std::sqrt(square(cross));
  const bool is_flat = !(area > least * longest);
  if (is_flat && !any) return false;
  const Vector first = normalizedOr(corners[1] - corners[0], Vector(1, 0, 0));
  Vector normal = anyAcross(first);
  if (!is_flat) {
    // Rounding tilts the normal of a sliver: make it perpendicular to the longest side again.
    normal = cross * (Scalar(1) / area);
    normal = normalizedOr(normal - glm::dot(normal, first) * first, normal);
  }
  for (std::size_t n = 0; n < 3; ++n) {
    const Vector& from = corners[n];
    const Vector side = corners[(n + 1) % 3] - from;
    Vector along = n == 0 || is_flat ? first : normalizedOr(side, first);
    if (is_flat && glm::dot(side, first) < Scalar(0)) along = -first;
    const Vector out = glm::cross(along, normal);
    const Scalar begin = glm::dot(along, from);
    for (int i = 0; i < 3; ++i) {
      facet.out[n][i] = static_cast<float>(out[i]);
      facet.along[n][i] = static_cast<float>(along[i]);
    }
    facet.out[n][3] = static_cast<float>(-glm::dot(out, from));
    facet.begin[n] = static_cast<float>(begin);
    facet.end[n] = static_cast<float>(begin + glm::dot(along, side));
  }
  for (int i = 0; i < 3; ++i) facet.normal[i] = static_cast<float>(normal[i]);
  facet.normal[3] = static_cast<float>(-glm::dot(normal, corners[0]));
  return true;
}

}  // namespace

Facet makeFacet(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  Facet facet{};
  const glm::vec3 p(a);
  const glm::vec3 q(b);
  const glm::vec3 r(c);
  const auto within = [](const glm::vec3& v, float most) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) < most;
  };
  if (within(p, kNear) && within(q - p, kShort) && within(r - p, kShort) && within(r - q, kShort) &&
      makeFacetOf<glm::vec3>({p, q, r}, kStout, false, facet)) {
    return facet;
  }
  makeFacetOf<Vec3>({a, b, c}, 1e-9, true, facet);
  return facet;
}

}  // namespace palpate::vdb
