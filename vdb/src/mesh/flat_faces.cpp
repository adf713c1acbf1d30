#include "mesh/flat_faces.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bake/edges.h"

namespace palpate::vdb {
namespace {

constexpr std::uint32_t kNone = 0xffffffffU;

/// The plane of a face: normal and offset are means over its triangles, weighted by area.
FlatFace planeOf(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                 const std::vector<std::uint32_t>& members) {
  FlatFace face;
  Vec3 sum(0.0);
  const Vec3& base = vertices[triangles[members.front()][0]];
  double moment = 0.0;
  double area = 0.0;
  for (const std::uint32_t t : members) {
    const auto& [i, j, k] = triangles[t];
    sum += glm::cross(vertices[j] - vertices[i], vertices[k] - vertices[i]);
  }
  face.normal = unitOr(sum, Vec3(0.0, 0.0, 1.0));
  for (const std::uint32_t t : members) {
    const auto& [i, j, k] = triangles[t];
    const double here = areaOf(vertices, triangles[t]);
    moment += here * glm::dot(face.normal, (vertices[i] + vertices[j] + vertices[k]) / 3.0 - base);
    area += here;
    face.vertices.insert(face.vertices.end(), {i, j, k});
  }
  face.offset = glm::dot(face.normal, base) + (area > 0.0 ? moment / area : 0.0);
  std::sort(face.vertices.begin(), face.vertices.end());
  face.vertices.erase(std::unique(face.vertices.begin(), face.vertices.end()), face.vertices.end());
  return face;
}

}  // namespace

std::optional<FlatFaces> findFlatFaces(const std::vector<Vec3>& vertices,
                                       const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                       double tolerance, std::size_t most) {
  const std::vector<Side> sides = sortedSides(triangles);
  std::vector<std::array<std::uint32_t, 3>> neighbors(triangles.size(), {kNone, kNone, kNone});
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      for (std::size_t m = begin; m < end; ++m) {
        if (n == m || end - begin != 2) continue;
        auto& list = neighbors[sides[n].triangle];
        *std::find(list.begin(), list.end(), kNone) = sides[m].triangle;
      }
    }
  });
  std::vector<std::uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<double> areas(triangles.size());
  for (std::uint32_t t = 0; t < areas.size(); ++t) areas[t] = areaOf(vertices, triangles[t]);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return areas[a] > areas[b]; });
  FlatFaces found;
  std::vector<std::uint32_t> face_of(triangles.size(), kNone);
  std::vector<std::uint32_t> members;
  for (const std::uint32_t seed : order) {
    if (face_of[seed] != kNone) continue;
    if (found.faces.size() == most) return {};
    const auto number = static_cast<std::uint32_t>(found.faces.size());
    const auto& [i, j, k] = triangles[seed];
    const Vec3 corner = vertices[i];
    const Vec3 normal = unitOr(glm::cross(vertices[j] - corner, vertices[k] - corner), Vec3(0.0));
    members.assign(1, seed);
    face_of[seed] = number;
    for (std::size_t n = 0; n < members.size(); ++n) {
      for (const std::uint32_t next : neighbors[members[n]]) {
        if (next == kNone || face_of[next] != kNone) continue;
        const auto& [a, b, c] = triangles[next];
        const auto is_off = [&](std::uint32_t v) {
          return std::abs(glm::dot(normal, vertices[v] - corner)) > tolerance;
        };
        const Vec3 turned = glm::cross(vertices[b] - vertices[a], vertices[c] - vertices[a]);
        // A triangle folded back onto the plane, as in a plate without thickness, belongs to
        // another face.
        if (is_off(a) || is_off(b) || is_off(c) || glm::dot(turned, normal) < 0.0) continue;
        face_of[next] = number;
        members.push_back(next);
      }
    }
    found.faces.push_back(planeOf(vertices, triangles, members));
  }
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2) return;
    const std::uint32_t a = face_of[sides[begin].triangle];
    const std::uint32_t b = face_of[sides[begin + 1].triangle];
    if (a != b) found.edges.push_back({a, b, sides[begin].low, sides[begin].high});
  });
  return found;
}

}  // namespace palpate::vdb
