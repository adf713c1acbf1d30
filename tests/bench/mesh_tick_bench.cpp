// Time of a tick, and errors of surface points and normals, on meshes with sharp edges: as plain
// bricks, with exact triangles near edges, and as half-spaces; in strokes over faces and edges, 1
// mm deep. One row for each. palpate_mesh_tick [MESH]: also for a mesh from a file (a tooth, say),
// scaled to a length of 50 mm.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/mesh.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;
constexpr double kVoxel = 0.5 * kMm;
constexpr double kDegree = std::numbers::pi / 180.0;

ScenePtr sceneOf(FieldPtr field) {
  SceneDescription description;
  LayerDescription layer;
  layer.name = "solid";
  layer.inside = std::make_shared<FieldSource>(std::move(field));
  description.layers.push_back(layer);
  return compile(description);
}

/// A prism over a star-shaped polygon about the z axis: a wedge, a star, a can.
Mesh prism(const std::vector<Vec3>& corners, double half) {
  Mesh mesh;
  mesh.source = "prism";
  const auto n = static_cast<std::uint32_t>(corners.size());
  for (const double z : {-half, half}) {
    for (const Vec3& c : corners) mesh.vertices.emplace_back(c.x, c.y, z);
  }
  mesh.vertices.emplace_back(0.0, 0.0, -half);
  mesh.vertices.emplace_back(0.0, 0.0, half);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.insert(mesh.triangles.end(), {{i, next, n + next},
                                                 {i, n + next, n + i},
                                                 {2 * n, next, i},
                                                 {2 * n + 1, n + i, n + next}});
  }
  return mesh;
}

std::vector<Vec3> round(int count, double even, double odd) {
  std::vector<Vec3> corners;
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * std::numbers::pi * i / count + 0.1;
    corners.push_back((i % 2 == 0 ? even : odd) * Vec3(std::cos(a), std::sin(a), 0.0));
  }
  return corners;
}

struct Row {
  double median = 0.0, late = 0.0;   // [ns] of a tick; late: the 99.9 % quantile
  double place = 0.0, normal = 0.0;  // [m], [degree] largest error near edges
};

/// Strokes between random points of the surface's box, a millimeter inside it.
Row measured(const FieldPtr& field, const FieldPtr& bricks, const Mesh& mesh) {
  Row row;
  // Near the middles of sides, a fifth of a voxel off the surface, the mesh's own face gives the
  // truth.
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 corners[] = {mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]};
    const Vec3 normal =
        glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    for (int n = 0; n < 3; ++n) {
      const Vec3 on_side = 0.5 * (corners[n] + corners[(n + 1) % 3]);
      // Where parts overlap, a wall inside the solid does not belong to its surface.
      if (!bricks->sample(on_side).in_band || std::abs(bricks->value(on_side)) > 2.0 * kVoxel)
        continue;
      const Vec3 at = on_side + 0.2 * kVoxel * glm::normalize(middle - on_side);
      const FieldSample here = field->sample(at + 0.02 * kVoxel * normal);
      row.place = std::max(row.place, std::abs(here.value - 0.02 * kVoxel));
      const Vec3 gradient = unitOr(here.gradient, -normal);
      row.normal = std::max(row.normal, std::atan2(glm::length(glm::cross(gradient, normal)),
                                                   glm::dot(gradient, normal)) /
                                            kDegree);
    }
  }
  const auto renderer = makeRenderer(sceneOf(field), {});
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.include(v);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  const auto goal = [&] {
    return box.lo + Vec3(any(random), any(random), any(random)) * box.size();
  };
  // The path that a hand would take over the surface: the field brings each point to a depth of 1
  // mm.
  std::vector<Vec3> path;
  Vec3 p = box.hi + 2.0 * kMm;
  for (Vec3 to = goal(); path.size() < 60000;) {
    if (glm::distance(p, to) < 1.0 * kMm) to = goal();
    p += 0.2 * kMm * glm::normalize(to - p);
    Vec3 q = p;
    for (int n = 0; n < 30; ++n) {
      const FieldSample s = field->sample(q);
      if (!s.in_band) {
        q -= (s.value + 1.0 * kMm) * glm::normalize(q - box.center());
        continue;
      }
      q -= (s.value + 1.0 * kMm) * s.gradient / std::max(0.1, glm::dot(s.gradient, s.gradient));
    }
    path.push_back(q);
  }
  std::vector<double> best(path.size(), 1e9);
  for (int round = 0; round < 5; ++round) {
    renderer->reset();
    for (std::size_t n = 0; n < path.size(); ++n) {
      const auto start = std::chrono::steady_clock::now();
      (void)renderer->update({path[n], Vec3(0.0)});
      const std::chrono::duration<double, std::nano> took =
          std::chrono::steady_clock::now() - start;
      best[n] = std::min(best[n], took.count());
    }
  }
  std::sort(best.begin(), best.end());
  row.median = best[best.size() / 2];
  row.late = best[best.size() * 999 / 1000];
  return row;
}

void print(const char* shape, const char* as, const Row& row) {
  std::printf("| %-7s | %-11s | %7.4f | %6.2f | %6.0f | %6.0f |\n", shape, as, row.place * 1e3,
              row.normal, row.median, row.late);
}

void compare(const char* name, const Mesh& mesh) {
  const FieldPtr bricks = gridField(bakeMesh(mesh, test::voxels(kVoxel)));
  print(name, "bricks", measured(bricks, bricks, mesh));
  try {
    const SharpField sharp = withSharpEdges(bricks, mesh, 30.0 * kDegree, kVoxel);
    print(name, "sharp", measured(sharp.field, bricks, mesh));
    if (sharp.left_to_grid > 0) {
      std::printf("| %-7s | sharp       | %zu of %zu edges left to the grid |\n", name,
                  sharp.left_to_grid, sharp.edges);
    }
  } catch (const Error& error) {
    std::printf("| %-7s | sharp       | %s |\n", name, error.what());
  }
  if (const FieldPtr solid = polyhedronField(mesh))
    print(name, "half-spaces", measured(solid, bricks, mesh));
}

/// A mesh from a file, scaled like the others: its longest side is 50 mm.
Mesh meshOf(const char* path) {
  Mesh mesh = readMesh(path, kMm);
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.include(v);
  const Vec3 size = box.size();
  const double scale = 50.0 * kMm / std::max({size.x, size.y, size.z});
  for (Vec3& v : mesh.vertices) v *= scale;
  return mesh;
}

}  // namespace
}  // namespace palpate::vdb

int main(int argc, char** argv) {
  using namespace palpate::vdb;  // NOLINT(google-build-using-namespace)
  std::printf(
      "| shape | as | place mm | normal degree | median ns | 99.9 %% ns |\n"
      "|---|---|---|---|---|---|\n");
  const double mm = 1e-3;
  compare("cube", test::boxMesh(palpate::Vec3(0.0), palpate::Vec3(20 * mm)));
  compare("wedge", prism(round(3, 12 * mm, 12 * mm), 10 * mm));
  compare("star", prism(round(10, 15 * mm, 7 * mm), 6 * mm));
  compare("can", prism(round(160, 12 * mm, 12 * mm), 8 * mm));
  if (argc > 1) compare("file", meshOf(argv[1]));
  return 0;
}
