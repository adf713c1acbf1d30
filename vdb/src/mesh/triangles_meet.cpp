#include "mesh/triangles_meet.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "mesh/exact_side.h"

namespace palpate::vdb {
namespace {

using Corners = std::array<Vec3, 3>;

/// An axis along which the triangle projects to an area, or -1.
int flatAxis(const Corners& t) {
  const Vec3 normal = glm::abs(glm::cross(t[1] - t[0], t[2] - t[0]));
  const int most =
      normal.x > normal.y ? (normal.x > normal.z ? 0 : 2) : (normal.y > normal.z ? 1 : 2);
  for (int n = 0; n < 3; ++n) {
    const int axis = (most + n) % 3;
    if (sideOfLine(t[0], t[1], t[2], axis) != 0) return axis;
  }
  return -1;
}

bool holds(const Corners& t, const Vec3& p, int axis) {
  const int a = sideOfLine(t[0], t[1], p, axis);
  const int b = sideOfLine(t[1], t[2], p, axis);
  const int c = sideOfLine(t[2], t[0], p, axis);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// The point between p and q where a linear function, `from` at p and `to` at q, is zero.
Vec3 between(const Vec3& p, const Vec3& q, double from, double to) {
  const double share = std::clamp(from == to ? 0.5 : from / (from - to), 0.0, 1.0);
  return p + share * (q - p);
}

/// Whether r, on the line through p and q, lies between them.
bool isBetween(const Vec3& p, const Vec3& q, const Vec3& r) {
  return glm::all(glm::lessThanEqual(glm::min(p, q), r)) &&
         glm::all(glm::lessThanEqual(r, glm::max(p, q)));
}

/// Where two sides in one plane meet, as seen along `axis`.
std::optional<Vec3> sidesMeet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                              int axis) {
  const int pa = sideOfLine(p, q, a, axis);
  const int pb = sideOfLine(p, q, b, axis);
  const int ap = sideOfLine(a, b, p, axis);
  const int aq = sideOfLine(a, b, q, axis);
  if (pa == 0 && isBetween(p, q, a)) return a;
  if (pb == 0 && isBetween(p, q, b)) return b;
  if (ap == 0 && isBetween(a, b, p)) return p;
  if (aq == 0 && isBetween(a, b, q)) return q;
  if (pa * pb >= 0 || ap * aq >= 0) return {};
  const double from = glm::cross(b - a, p - a)[axis];
  const double to = glm::cross(b - a, q - a)[axis];
  return between(p, q, from, to);
}

/// Where the side from p to q meets the triangle.
std::optional<Vec3> sideMeets(const Vec3& p, const Vec3& q, const Corners& t, int axis) {
  const int before = sideOfPlane(t[0], t[1], t[2], p);
  const int after = sideOfPlane(t[0], t[1], t[2], q);
  if (before * after > 0) return {};
  if (before == 0 && after == 0) {
    if (holds(t, p, axis)) return p;
    if (holds(t, q, axis)) return q;
    for (std::size_t n = 0; n < 3; ++n) {
      if (const auto at = sidesMeet(p, q, t[n], t[(n + 1) % 3], axis)) return at;
    }
    return {};
  }
  bool left = false;
  bool right = false;
  for (std::size_t n = 0; n < 3; ++n) {
    const int side = sideOfPlane(p, q, t[n], t[(n + 1) % 3]);
    left = left || side > 0;
    right = right || side < 0;
  }
  if (left && right) return {};
  const Vec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  return between(p, q, glm::dot(normal, p - t[0]), glm::dot(normal, q - t[0]));
}

/// Permutes both so that shared corners come first; returns how many there are.
std::size_t putSharedFirst(std::array<std::uint32_t, 3>& one, std::array<std::uint32_t, 3>& other) {
  std::size_t shared = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    auto* const at =
        std::find(other.begin() + static_cast<std::ptrdiff_t>(shared), other.end(), one[n]);
    if (at == other.end()) continue;
    std::swap(other[shared], *at);
    std::swap(one[shared], one[n]);
    ++shared;
  }
  return shared;
}

}  // namespace

std::optional<Vec3> trianglesMeet(const std::vector<Vec3>& vertices,
                                  const std::array<std::uint32_t, 3>& one,
                                  const std::array<std::uint32_t, 3>& other) {
  std::array<std::uint32_t, 3> mine = one;
  std::array<std::uint32_t, 3> its = other;
  const std::size_t shared = putSharedFirst(mine, its);
  if (shared == 3) return {};
  const Corners s{vertices[mine[0]], vertices[mine[1]], vertices[mine[2]]};
  const Corners t{vertices[its[0]], vertices[its[1]], vertices[its[2]]};
  const int s_axis = flatAxis(s);
  const int t_axis = flatAxis(t);
  if (s_axis < 0 || t_axis < 0) return {};
  if (shared == 2) {
    // Either their planes meet only along the shared side, or both lie in one plane; then they
    // overlap only if they are on the same side of it.
    if (sideOfPlane(s[0], s[1], s[2], t[2]) != 0 ||
        sideOfLine(s[0], s[1], s[2], s_axis) != sideOfLine(s[0], s[1], t[2], s_axis)) {
      return {};
    }
    return 0.5 * (s[0] + s[1]);
  }
  if (shared == 1) {
    // The common segment begins at the shared corner, and ends at the far side of one of the
    // triangles.
    if (const auto at = sideMeets(s[1], s[2], t, t_axis)) return at;
    return sideMeets(t[1], t[2], s, s_axis);
  }
  const auto apart = [](const Corners& a, const Corners& b) {
    const int first = sideOfPlane(a[0], a[1], a[2], b[0]);
    return first != 0 && first == sideOfPlane(a[0], a[1], a[2], b[1]) &&
           first == sideOfPlane(a[0], a[1], a[2], b[2]);
  };
  if (apart(s, t) || apart(t, s)) return {};
  // The common part is a segment between two of these places, or a single one of them.
  Vec3 sum(0.0);
  double count = 0.0;
  for (std::size_t n = 0; n < 3; ++n) {
    for (const auto& at :
         {sideMeets(s[n], s[(n + 1) % 3], t, t_axis), sideMeets(t[n], t[(n + 1) % 3], s, s_axis)}) {
      if (!at) continue;
      sum += *at;
      count += 1.0;
    }
  }
  if (count == 0.0) return {};
  return sum / count;
}

}  // namespace palpate::vdb
