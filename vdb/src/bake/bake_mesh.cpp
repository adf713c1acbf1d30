#include <openvdb/tools/MeshToVolume.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <future>

#include "bake/bake_plan.h"
#include "palpate/vdb/bake.h"

namespace palpate::vdb {
namespace {

/// The mesh as OpenVDB wants it: points in index space.
class Adapter {
 public:
  Adapter(const Mesh& mesh, double voxel) : mesh_(mesh), voxel_(voxel) {}
  [[nodiscard]] std::size_t polygonCount() const { return mesh_.triangles.size(); }
  [[nodiscard]] std::size_t pointCount() const { return mesh_.vertices.size(); }
  [[nodiscard]] static std::size_t vertexCount(std::size_t) { return 3; }
  void getIndexSpacePoint(std::size_t n, std::size_t v, openvdb::Vec3d& point) const {
    const Vec3 p = mesh_.vertices[mesh_.triangles[n][v]] / voxel_;
    point = openvdb::Vec3d(p.x, p.y, p.z);
  }

 private:
  const Mesh& mesh_;
  double voxel_;
};

struct Interrupter {
  std::atomic<bool> stop = false;
  std::atomic<int> percent = -1;
  void start(const char* = nullptr) {}
  void end() {}
  bool wasInterrupted(int done = -1) {
    if (done >= 0) percent = done;
    return stop;
  }
};

void requireClosed(const Mesh& mesh) {
  const MeshReport found = checkMesh(mesh);
  if (found.isClosed()) return;
  const Vec3 at = found.first_boundary;
  throw inputError("mesh.open",
                   "the mesh is open: it has " + std::to_string(found.boundary_edges) +
                       " boundary edges, one of them at (" + inMillimetres(at.x) + ", " +
                       inMillimetres(at.y) + ", " + inMillimetres(at.z) + ")",
                   "close its holes in a mesh editor", mesh.source);
}

double area(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3& p = mesh.vertices[a];
    sum += 0.5 * glm::length(glm::cross(mesh.vertices[b] - p, mesh.vertices[c] - p));
  }
  return sum;
}

}  // namespace

LevelSet bakeMesh(const Mesh& mesh, const BakeOptions& options, const Progress& progress) {
  const BakePlan plan = checkOptions(options);
  requireClosed(mesh);
  requireMemory(area(mesh) / (plan.voxel * plan.voxel), 1.0, plan);
  const openvdb::FloatGrid::Ptr model = emptyGrid(plan, options);
  Interrupter interrupter;
  const auto width = static_cast<float>(options.half_width);
  // OpenVDB asks its interrupter from any thread; progress is for the calling one.
  std::future<openvdb::FloatGrid::Ptr> work = std::async(std::launch::async, [&] {
    const Adapter adapter(mesh, plan.voxel);
    return openvdb::tools::meshToVolume<openvdb::FloatGrid>(interrupter, adapter,
                                                            model->transform(), width, width);
  });
  try {
    while (work.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
      report(progress, "bake mesh", interrupter.percent / 100.0);
    }
  } catch (...) {
    interrupter.stop = true;
    work.wait();
    throw;
  }
  openvdb::FloatGrid::Ptr grid = work.get();
  grid->setName(options.name);
  return finishGrid(grid, plan, options);
}

}  // namespace palpate::vdb
