#include "bake/facet.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::vdb {
namespace {

/// [voxels] With corners no farther out, sides no longer and a height over length no less, floats tell a
/// facet to some 3e-6 voxel.
constexpr float kNear = 16.0F;
constexpr float kShort = 6.0F;
constexpr float kStout = 0.2F;

Vec3 anyAcross(const Vec3& v) noexcept {
  const Vec3 axis = std::abs(v.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  return unitOr(glm::cross(v, axis), axis);
}

/// Of any triangle.
Facet makeAnyFacet(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  std::array<Vec3, 3> corners{a, b, c};
  const std::array<double, 3> squares{glm::dot(b - a, b - a), glm::dot(c - b, c - b),
                                      glm::dot(a - c, a - c)};
  const auto longest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  std::rotate(corners.begin(), corners.begin() + longest, corners.end());
  const Vec3 first = unitOr(corners[1] - corners[0], Vec3(1.0, 0.0, 0.0));
  const Vec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double area = glm::length(cross);
  const bool is_flat = !(area > 1e-9 * squares[static_cast<std::size_t>(longest)]);
  Vec3 normal = anyAcross(first);
  if (!is_flat) {
    // Rounding tilts the normal of a sliver: made square to the longest side again.
    normal = cross / area;
    normal = unitOr(normal - glm::dot(normal, first) * first, normal);
  }
  Facet facet{};
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3& from = corners[n];
    const Vec3 side = corners[(n + 1) % 3] - from;
    Vec3 along = n == 0 || is_flat ? first : unitOr(side, first);
    if (is_flat && glm::dot(side, first) < 0.0) along = -first;
    const Vec3 out = glm::cross(along, normal);
    const double begin = glm::dot(along, from);
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
  return facet;
}

}  // namespace

Facet makeFacet(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const std::array<glm::vec3, 3> corners{glm::vec3(a), glm::vec3(b), glm::vec3(c)};
  std::array<glm::vec3, 3> sides{};
  std::array<float, 3> squares{};
  float farthest = 0.0F;
  for (std::size_t n = 0; n < 3; ++n) {
    sides[n] = corners[(n + 1) % 3] - corners[n];
    squares[n] = glm::dot(sides[n], sides[n]);
    farthest = std::max(farthest, glm::dot(corners[n], corners[n]));
  }
  const float longest = std::max({squares[0], squares[1], squares[2]});
  const glm::vec3 cross = glm::cross(sides[0], sides[1]);
  const float area = std::sqrt(glm::dot(cross, cross));
  if (!(farthest < kNear * kNear && longest < kShort * kShort && area > kStout * longest)) {
    return makeAnyFacet(a, b, c);
  }
  Facet facet{};
  const glm::vec3 normal = cross * (1.0F / area);
  // The longest side comes first.
  auto n = static_cast<std::size_t>(std::find(squares.begin(), squares.end(), longest) -
                                    squares.begin());
  for (std::size_t to = 0; to < 3; ++to, n = n == 2 ? 0 : n + 1) {
    const float length = std::sqrt(squares[n]);
    const glm::vec3 along = sides[n] * (1.0F / length);
    const glm::vec3 out = glm::cross(along, normal);
    for (int i = 0; i < 3; ++i) {
      facet.out[to][i] = out[i];
      facet.along[to][i] = along[i];
    }
    facet.out[to][3] = -glm::dot(out, corners[n]);
    facet.begin[to] = glm::dot(along, corners[n]);
    facet.end[to] = facet.begin[to] + length;
  }
  for (int i = 0; i < 3; ++i) facet.normal[i] = normal[i];
  facet.normal[3] = -glm::dot(normal, corners[0]);
  return facet;
}

}  // namespace palpate::vdb
