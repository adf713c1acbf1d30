#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "accuracy/points.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"

namespace palpate::bench {
namespace {

constexpr std::size_t kStrokes = 8;
constexpr std::size_t kStrokeLength = 512;  ///< points

Shape makeShape(std::string name, const vdb::LevelSet& grid, const FieldPtr& surface) {
  Shape shape;
  shape.name = std::move(name);
  shape.grid = grid;
  const double voxel = grid.info().voxel_size;
  const tools::Truth truth(surface);
  const auto points = tools::pointsNear(truth, 0.1 * voxel, 4 * kStrokes, voxel);
  // Fine grids are stroked in finer steps, so that successive points stay in neighboring voxels.
  const double step = std::min(0.2e-3, 0.4 * voxel);
  for (const auto& stroke :
       tools::strokesAlong(truth, points, kStrokes, kStrokeLength, step, voxel)) {
    for (const auto& point : stroke.points) {
      const double height = 0.5 * voxel * std::sin(0.05 * static_cast<double>(shape.path.size()));
      shape.path.push_back(point.at + height * point.truth.normal);
    }
  }
  return shape;
}

vdb::BakeOptions voxels(double size) {
  vdb::BakeOptions options;
  options.voxel_size = size;
  return options;
}

}  // namespace

Shape torusShape() {
  const FieldPtr torus =
      palpate::torus(Vec3(0.31e-3, -0.17e-3, 0.23e-3), Vec3(0.3, -0.5, 0.8), 35e-3, 15e-3);
  return makeShape("torus 35/15 mm, voxel 1 mm", vdb::bake(*torus, voxels(1e-3)), torus);
}

Shape ballShape() {
  const FieldPtr ball = sphere(Vec3(0.13e-3, 0.27e-3, -0.41e-3), 50e-3);
  return makeShape("ball 50 mm, voxel 0.5 mm", vdb::bake(*ball, voxels(0.5e-3)), ball);
}

Shape meshShape(const std::string& file) {
  const vdb::Mesh mesh = vdb::readMesh(file, 1e-3);
  Box3 bounds;
  for (const Vec3& v : mesh.vertices) bounds.include(v);
  const Vec3 size = bounds.size();
  const double voxel = std::max({size.x, size.y, size.z}) / 128.0;
  const vdb::LevelSet grid = vdb::bakeMesh(mesh, voxels(voxel));
  return makeShape(std::filesystem::path(file).filename().string() + ", longest side 128 voxels",
                   grid, vdb::gridField(grid));
}

}  // namespace palpate::bench
