// Baking balls of 20 k, 320 k and 1.3 M triangles to bands, at three voxel sizes, compared with
// OpenVDB's meshToVolume. Each row gives the length of the triangles' edges, because the cost of a
// mesh depends on it; 2 voxels are usual.

#include <benchmark/benchmark.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>
#include <numbers>

#include "bench/bake_bench.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

constexpr double kRadius = 50e-3;
const Vec3 kCenter(0.31e-3, -0.17e-3, 0.23e-3);

/// 20 * 4^levels triangles.
const Mesh& ball(int levels) {
  static std::map<int, Mesh> meshes;
  Mesh& mesh = meshes[levels];
  if (mesh.triangles.empty()) mesh = test::ballMesh(kCenter, kRadius, levels);
  return mesh;
}

/// [voxels] The edge of an equilateral triangle of the mean area.
void addEdge(benchmark::State& state, const Mesh& mesh) {
  const double area =
      4.0 * std::numbers::pi * kRadius * kRadius / static_cast<double>(mesh.triangles.size());
  const double voxel = kRadius / static_cast<double>(state.range(1));
  state.counters["edge_voxels"] = std::sqrt(4.0 * area / std::sqrt(3.0)) / voxel;
}

void ours(benchmark::State& state) {
  const Mesh& mesh = ball(static_cast<int>(state.range(0)));
  const bench::Threads threads(state.range(2));
  const BakeOptions options =
      test::voxels(kRadius / static_cast<double>(state.range(1)), bench::kHalfWidth);
  std::uint64_t voxels = 0;
  for (auto run : state) voxels = bakeMesh(mesh, options).info().active_voxels;
  bench::perVoxel(state, voxels);
  addEdge(state, mesh);
}

struct Adapter {
  const Mesh& mesh;
  double voxel;
  [[nodiscard]] std::size_t polygonCount() const { return mesh.triangles.size(); }
  [[nodiscard]] std::size_t pointCount() const { return mesh.vertices.size(); }
  [[nodiscard]] static std::size_t vertexCount(std::size_t) { return 3; }
  void getIndexSpacePoint(std::size_t n, std::size_t v, openvdb::Vec3d& point) const {
    const Vec3 p = mesh.vertices[mesh.triangles[n][v]] / voxel;
    point = openvdb::Vec3d(p.x, p.y, p.z);
  }
};

void meshToVolume(benchmark::State& state) {
  openvdb::initialize();
  const Adapter adapter{ball(static_cast<int>(state.range(0))),
                        kRadius / static_cast<double>(state.range(1))};
  const bench::Threads threads(state.range(2));
  const auto transform = openvdb::math::Transform::createLinearTransform(adapter.voxel * 1e3);
  const auto width = static_cast<float>(bench::kHalfWidth);
  std::uint64_t voxels = 0;
  for (auto run : state) {
    voxels = openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *transform, width, width)
                 ->activeVoxelCount();
  }
  bench::perVoxel(state, voxels);
  addEdge(state, adapter.mesh);
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"levels", "R/h", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();
  for (const int levels : {5, 7, 8}) {
    for (const int resolution : {100, 200, 400}) bench->Args({levels, resolution, 1});
  }
  bench->Args({7, 200, 2});
}

/// This takes up to half a minute for each size: run it once, where edges are nearest to 2 voxels.
void fewSizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"levels", "R/h", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();
  bench->Iterations(1)->Repetitions(1);
  bench->Args({5, 100, 1})->Args({7, 200, 1})->Args({7, 200, 2})->Args({8, 400, 1});
}

BENCHMARK(ours)->Name("mesh/palpate")->Apply(sizes);
BENCHMARK(meshToVolume)->Name("mesh/meshToVolume")->Apply(fewSizes);

}  // namespace
}  // namespace palpate::vdb
