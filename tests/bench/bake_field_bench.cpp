// An analytic ball and a CSG of fourteen parts into bands, beside OpenVDB's createLevelSetSphere.

#include <benchmark/benchmark.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <vector>

#include "bench/bake_bench.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

constexpr double kRadius = 50e-3;
const Vec3 kCenter(0.31e-3, -0.17e-3, 0.23e-3);

/// A box, eight balls cut out of its corners, three cylinders and two balls added.
FieldPtr fourteenParts() {
  std::vector<FieldPtr> cut;
  for (int n = 0; n < 8; ++n) {
    const Vec3 corner((n & 1) != 0 ? 30e-3 : -30e-3, (n & 2) != 0 ? 20e-3 : -20e-3,
                      (n & 4) != 0 ? 25e-3 : -25e-3);
    cut.push_back(sphere(kCenter + corner, 9e-3));
  }
  const FieldPtr body =
      intersect({box(kCenter, Vec3(60e-3, 40e-3, 50e-3)), complement(unite(cut))});
  return unite({body, cylinder(kCenter, Vec3(1.0, 0.0, 0.0), 8e-3, 90e-3),
                cylinder(kCenter, Vec3(0.0, 1.0, 0.0), 8e-3, 70e-3),
                cylinder(kCenter, Vec3(0.0, 0.0, 1.0), 8e-3, 80e-3),
                sphere(kCenter + Vec3(45e-3, 0.0, 0.0), 12e-3),
                sphere(kCenter + Vec3(0.0, 0.0, 40e-3), 12e-3)});
}

void bakeOf(benchmark::State& state, const FieldPtr& field) {
  const bench::Threads threads(state.range(1));
  const BakeOptions options =
      test::voxels(kRadius / static_cast<double>(state.range(0)), bench::kHalfWidth);
  std::uint64_t voxels = 0;
  for (auto run : state) voxels = bake(*field, options).info().active_voxels;
  bench::perVoxel(state, voxels);
}

void ball(benchmark::State& state) { bakeOf(state, sphere(kCenter, kRadius)); }
void csg(benchmark::State& state) { bakeOf(state, fourteenParts()); }

void createLevelSetSphere(benchmark::State& state) {
  openvdb::initialize();
  const bench::Threads threads(state.range(1));
  const openvdb::Vec3f center(0.31F, -0.17F, 0.23F);
  std::uint64_t voxels = 0;
  for (auto run : state) {
    voxels = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
                 50.0F, center, 50.0F / static_cast<float>(state.range(0)),
                 static_cast<float>(bench::kHalfWidth), state.range(1) > 1)
                 ->activeVoxelCount();
  }
  bench::perVoxel(state, voxels);
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"R/h", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();
  for (const int threads : {1, 2}) {
    for (const int resolution : {100, 200, 400}) bench->Args({resolution, threads});
  }
}

BENCHMARK(ball)->Name("ball/palpate")->Apply(sizes);
BENCHMARK(createLevelSetSphere)->Name("ball/createLevelSetSphere")->Apply(sizes);
BENCHMARK(csg)->Name("csg14/palpate")->Apply(sizes);

}  // namespace
}  // namespace palpate::vdb
