#include <openvdb/tools/VolumeToMesh.h>

#include <cmath>

#include "palpate/core/error.h"
#include "palpate/vdb/mesh.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

/// Newton's method along the gradient. The start is in the middle of the cell, at most a voxel
/// away: three steps reach a thousandth of a voxel on any field that is nearly a distance.
Vec3 ontoSurface(const Field& field, const Vec3& from) {
  constexpr int kSteps = 4;
  const double voxel = field.featureSize();
  Vec3 p = from;
  for (int step = 0; step < kSteps; ++step) {
    const FieldSample sample = field.sample(p);
    const double square = glm::dot(sample.gradient, sample.gradient);
    // At an edge of the solid, where the gradient nearly vanishes, the cell's own vertex is better.
    if (!sample.in_band || !(square > 0.04)) return from;
    p -= sample.gradient * (sample.value / square);
    if (!(glm::length(p - from) < voxel)) return from;
    if (std::abs(sample.value) < 1e-6 * voxel) break;
  }
  return p;
}

double signedVolume(const Mesh& mesh) {
  double six = 0.0;
  const Vec3 base = mesh.vertices.front();
  for (const auto& t : mesh.triangles) {
    six += glm::dot(mesh.vertices[t[0]] - base,
                    glm::cross(mesh.vertices[t[1]] - base, mesh.vertices[t[2]] - base));
  }
  return six;
}

}  // namespace

Mesh surfaceMesh(const LevelSet& grid, const Progress& progress) {
  report(progress, "surface", 0.0);
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid.impl().grid, points, triangles, quads, 0.0, 0.0);
  if (triangles.empty() && quads.empty()) {
    throw inputError("grid.no_surface", "the grid '" + grid.info().name + "' has no surface",
                     "no voxel of it is inside");
  }
  report(progress, "surface", 0.5);
  const FieldPtr field = gridField(grid);
  Mesh mesh;
  mesh.source = grid.info().name;
  mesh.vertices.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 65536 == 0) {
      report(progress, "surface",
             0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(points.size()));
    }
    const openvdb::Vec3s& p = points[i];
    mesh.vertices.push_back(
        ontoSurface(*field, grid.info().meters_per_unit * Vec3(p.x(), p.y(), p.z())));
  }
  mesh.triangles.reserve(triangles.size() + 2 * quads.size());
  for (const openvdb::Vec3I& t : triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
  const auto length = [&](const openvdb::Vec4I& q, int a, int b) {
    return glm::length(mesh.vertices[q[a]] - mesh.vertices[q[b]]);
  };
  for (const openvdb::Vec4I& q : quads) {
    if (length(q, 0, 2) <= length(q, 1, 3)) {
      mesh.triangles.push_back({q[0], q[1], q[2]});
      mesh.triangles.push_back({q[0], q[2], q[3]});
    } else {
      mesh.triangles.push_back({q[0], q[1], q[3]});
      mesh.triangles.push_back({q[1], q[2], q[3]});
    }
  }
  // OpenVDB does not promise an orientation; a solid's volume has to be positive.
  if (signedVolume(mesh) < 0.0) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  report(progress, "surface", 1.0);
  return mesh;
}

}  // namespace palpate::vdb
