#pragma once
/// The edges of a mesh, with the triangles along each.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

using Triangle = std::array<std::uint32_t, 3>;

/// A side of a triangle, named by its vertices in a fixed order, so that all triangles on this edge
/// use the same name.
struct Side {
  std::uint32_t low, high;
  std::uint32_t triangle;
  bool upwards;  ///< runs from low to high

  [[nodiscard]] bool sameEdge(const Side& other) const noexcept {
    return low == other.low && high == other.high;
  }
};

[[nodiscard]] std::vector<Side> sortedSides(const std::vector<Triangle>& triangles);

/// Calls visit(begin, end) with the range of sides of each edge.
template <typename Visit>
void forEachEdge(const std::vector<Side>& sides, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].sameEdge(sides[begin])) ++end;
    visit(begin, end);
  }
}

[[nodiscard]] inline double areaOf(const std::vector<Vec3>& vertices, const Triangle& t) {
  const Vec3& a = vertices[t[0]];
  return 0.5 * glm::length(glm::cross(vertices[t[1]] - a, vertices[t[2]] - a));
}

/// Turns triangles so that neighbors across edges with two triangles agree; other edges bound the
/// patches, in each of which the larger area decides. Returns which triangles were turned.
std::vector<bool> turnAlike(const std::vector<Vec3>& vertices, const std::vector<Side>& sides,
                            std::vector<Triangle>& triangles);

/// A hole in what should be a closed surface.
struct Hole {
  std::vector<std::uint32_t> loop;  ///< vertices, in the direction of the missing triangles
  std::vector<Triangle> lid;        ///< triangles over it
  double area = 0.0;                ///< of the lid
};

/// Finds loops along which triangles run one way only, and triangles that close them: those of
/// least area for loops of up to a hundred corners, else a fan about the loop's middle, which
/// becomes a new vertex.
[[nodiscard]] std::vector<Hole> closeHoles(std::vector<Vec3>& vertices,
                                           const std::vector<Side>& sides);

}  // namespace palpate::vdb
