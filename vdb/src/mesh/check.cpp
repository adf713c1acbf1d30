#include <algorithm>
#include <numeric>

#include "palpate/vdb/mesh.h"

namespace palpate::vdb {
namespace {

/// A side of a triangle, named by its vertices in a fixed order, so that both triangles use the
/// same name.
struct HalfEdge {
  std::uint32_t low;
  std::uint32_t high;
  bool upwards;  ///< runs from low to high

  [[nodiscard]] bool sameEdge(const HalfEdge& other) const noexcept {
    return low == other.low && high == other.high;
  }
  friend bool operator<(const HalfEdge& a, const HalfEdge& b) noexcept {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  }
};

/// Connected components of vertices, joined by triangles.
class Components {
 public:
  explicit Components(std::size_t vertices) : parent_(vertices) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }
  std::uint32_t root(std::uint32_t v) {
    while (parent_[v] != v) {
      parent_[v] = parent_[parent_[v]];
      v = parent_[v];
    }
    return v;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

void countEdges(const Mesh& mesh, MeshReport& report) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t from = triangle[side];
      const std::uint32_t to = triangle[(side + 1) % 3];
      if (from != to) edges.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].sameEdge(edges[begin])) ++end;
    const std::size_t triangles = end - begin;
    if (triangles == 1 && report.boundary_edges++ == 0) {
      report.first_boundary =
          0.5 * (mesh.vertices[edges[begin].low] + mesh.vertices[edges[begin].high]);
    }
    if (triangles > 2) ++report.non_manifold_edges;
    if (triangles == 2 && edges[begin].upwards == edges[begin + 1].upwards) ++report.flipped_edges;
  }
}

}  // namespace

MeshReport checkMesh(const Mesh& mesh) {
  MeshReport report;
  Components components(mesh.vertices.size());
  std::vector<bool> used(mesh.vertices.size(), false);
  const Vec3 reference = mesh.vertices.empty() ? Vec3(0.0) : mesh.vertices.front();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 u = mesh.vertices[a] - reference;
    const Vec3 v = mesh.vertices[b] - reference;
    const Vec3 w = mesh.vertices[c] - reference;
    report.volume += glm::dot(u, glm::cross(v, w)) / 6.0;
    if (glm::cross(v - u, w - u) == Vec3(0.0)) ++report.degenerate_triangles;
    components.join(a, b);
    components.join(b, c);
    for (const std::uint32_t vertex : {a, b, c}) {
      used[vertex] = true;
      report.bounds.include(mesh.vertices[vertex]);
    }
  }
  for (std::uint32_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    if (used[vertex] && components.root(vertex) == vertex) ++report.components;
  }
  countEdges(mesh, report);
  return report;
}

}  // namespace palpate::vdb
