#include "vdb/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace palpate::vdb::test {

FieldPtr torus(double big, double small) {
  const auto function = [=](const Vec3& p) {
    const double ring = std::hypot(p.x, p.y);
    const double tube = std::hypot(ring - big, p.z);
    if (ring == 0.0 || tube == 0.0) return FieldSample{tube - small, Vec3(0.0, 0.0, 1.0), true};
    const double along = (ring - big) / tube;
    return FieldSample{tube - small, Vec3(along * p.x / ring, along * p.y / ring, p.z / tube),
                       true};
  };
  const Vec3 reach(big + small, big + small, small);
  return std::make_shared<FunctionField>(function, FunctionField::Claims{{-reach, reach}});
}

FieldPtr implicitBall(double radius) {
  const auto function = [=](const Vec3& p) {
    return FieldSample{glm::dot(p, p) / radius - radius, p * (2.0 / radius), true};
  };
  FunctionField::Claims claims;
  claims.bounds = {Vec3(-radius), Vec3(radius)};
  claims.metric = Metric::kImplicit;
  claims.lipschitz_domain = claims.bounds;
  claims.lipschitz = 2.0 * std::sqrt(3.0);  // at the corners of the box
  return std::make_shared<FunctionField>(function, claims);
}

BakeOptions voxels(double size, double half_width) {
  BakeOptions options;
  options.voxel_size = size;
  options.half_width = half_width;
  return options;
}

Mesh boxMesh(const Vec3& center, const Vec3& size) {
  Mesh mesh;
  mesh.source = "box";
  for (int n = 0; n < 8; ++n) {
    mesh.vertices.push_back(center + size * (Vec3(n & 1, n >> 1 & 1, n >> 2) - Vec3(0.5)));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Mesh ballMesh(const Vec3& center, double radius, int levels) {
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  Mesh mesh;
  mesh.source = "ball";
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-golden, golden}) {
      mesh.vertices.insert(mesh.vertices.end(), {Vec3(0, a, b), Vec3(a, b, 0), Vec3(b, 0, a)});
    }
  }
  // The faces of an icosahedron: triples of corners that are an edge (2) apart.
  const auto is_edge = [&](std::uint32_t i, std::uint32_t j) {
    return std::abs(glm::distance(mesh.vertices[i], mesh.vertices[j]) - 2.0) < 1e-9;
  };
  for (std::uint32_t i = 0; i < 12; ++i) {
    for (std::uint32_t j = i + 1; j < 12; ++j) {
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        if (!is_edge(i, j) || !is_edge(j, k) || !is_edge(i, k)) continue;
        const Vec3 normal =
            glm::cross(mesh.vertices[j] - mesh.vertices[i], mesh.vertices[k] - mesh.vertices[i]);
        const bool outwards = glm::dot(normal, mesh.vertices[i]) > 0.0;
        mesh.triangles.push_back({i, outwards ? j : k, outwards ? k : j});
      }
    }
  }
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(mesh.vertices[a] + mesh.vertices[b]);
      return entry->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (auto& v : mesh.vertices) v = glm::normalize(v);
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& v : mesh.vertices) v = center + radius * glm::normalize(v);
  return mesh;
}

Mesh together(const Mesh& a, const Mesh& b, bool inside_out) {
  Mesh mesh = a;
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (auto [i, j, k] : b.triangles) {
    if (inside_out) std::swap(j, k);
    mesh.triangles.push_back({i + shift, j + shift, k + shift});
  }
  return mesh;
}

}  // namespace palpate::vdb::test
