#include "bake/facet.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::vdb {
namespace {

Vec3 anyAcross(const Vec3& v) noexcept {
  const Vec3 axis = std::abs(v.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  return unitOr(glm::cross(v, axis), axis);
}

}  // namespace

Facet makeFacet(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
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

}  // namespace palpate::vdb
