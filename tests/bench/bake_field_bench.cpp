// Baking an analytic ball, a CSG of fourteen parts and four implicit shapes to bands, compared with
// OpenVDB's createLevelSetSphere; and a band to bricks.

#include <benchmark/benchmark.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <optional>
#include <utility>
#include <vector>

#include "bench/bake_bench.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "vdb/counted_field.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

constexpr double kRadius = 50e-3;
const Vec3 kCenter(0.31e-3, -0.17e-3, 0.23e-3);

/// A box with eight balls cut out of its corners, and three rings and two balls added.
FieldPtr fourteenParts() {
  std::vector<FieldPtr> cut;
  for (int n = 0; n < 8; ++n) {
    const Vec3 corner((n & 1) != 0 ? 30e-3 : -30e-3, (n & 2) != 0 ? 20e-3 : -20e-3,
                      (n & 4) != 0 ? 25e-3 : -25e-3);
    cut.push_back(sphere(kCenter + corner, 9e-3));
  }
  const FieldPtr body =
      intersect({box(kCenter, Vec3(60e-3, 40e-3, 50e-3)), complement(unite(cut))});
  return unite({body, torus(kCenter, Vec3(1.0, 0.0, 0.0), 28e-3, 5e-3),
                torus(kCenter, Vec3(0.0, 1.0, 0.0), 32e-3, 5e-3),
                torus(kCenter, Vec3(0.0, 0.0, 1.0), 34e-3, 5e-3),
                sphere(kCenter + Vec3(45e-3, 0.0, 0.0), 12e-3),
                sphere(kCenter + Vec3(0.0, 0.0, 40e-3), 12e-3)});
}

BakeOptions optionsOf(const benchmark::State& state, double half_width) {
  return test::voxels(kRadius / static_cast<double>(state.range(0)), half_width);
}

void bakeOf(benchmark::State& state, const FieldPtr& field) {
  const bench::Threads threads(state.range(1));
  const BakeOptions options = optionsOf(state, bench::kHalfWidth);
  const auto make = [&] { return bake(*field, options); };
  bench::perVoxel(state, bench::timed(state, make).info().active_voxels);
  bench::addPeak(state, [&]() -> bench::Made {
    const auto set = std::make_shared<const LevelSet>(make());
    return {set, set->info().memory};
  });
}

void ball(benchmark::State& state) { bakeOf(state, sphere(kCenter, kRadius)); }
void csg(benchmark::State& state) { bakeOf(state, fourteenParts()); }

/// Fields whose values are not distances, so that the bake searches for closest points. Also counts
/// queries of the field for each voxel.
void bakeImplicit(benchmark::State& state, const FieldPtr& field,
                  const std::optional<Box3>& box = {}) {
  const bench::Threads threads(state.range(1));
  BakeOptions options = optionsOf(state, kCubicHalfWidth);
  options.box = box;
  const LevelSet made = bench::timed(state, [&] { return bake(*field, options); });
  bench::perVoxel(state, made.info().active_voxels);
  const test::Counted counted(field);
  const LevelSet again = bake(counted, options);
  state.counters["looks_per_voxel"] =
      counted.looks() / static_cast<double>(again.info().active_voxels);
}

void heartShape(benchmark::State& state) { bakeImplicit(state, heart(kCenter, 2.0 * kRadius)); }
void metaballPair(benchmark::State& state) {
  bakeImplicit(state, metaballs({{kCenter - Vec3(20e-3, 0.0, 0.0), 55e-3, 1.0},
                                 {kCenter + Vec3(25e-3, 0.0, 0.0), 65e-3, 1.0}},
                                FallOff::kWyvill, 0.4));
}
void gyroidBlock(benchmark::State& state) {
  bakeImplicit(state, gyroid(kCenter, 0.8 * kRadius), Box3{Vec3(-kRadius), Vec3(kRadius)});
}
void quadricEgg(benchmark::State& state) {
  QuadricCoefficients egg;
  egg.xx = 1.0 / (kRadius * kRadius);
  egg.yy = 1.0 / (0.7 * kRadius * 0.7 * kRadius);
  egg.zz = 1.0 / (0.6 * kRadius * 0.6 * kRadius);
  egg.constant = -1.0;
  bakeImplicit(state, quadric(kCenter, egg));
}

void createLevelSetSphere(benchmark::State& state) {
  openvdb::initialize();
  const bench::Threads threads(state.range(1));
  const openvdb::Vec3f center(0.31F, -0.17F, 0.23F);
  const auto make = [&] {
    return openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
        50.0F, center, 50.0F / static_cast<float>(state.range(0)),
        static_cast<float>(bench::kHalfWidth), state.range(1) > 1);
  };
  bench::perVoxel(state, bench::timed(state, make)->activeVoxelCount());
  bench::addPeak(state, [&]() -> bench::Made {
    const openvdb::FloatGrid::Ptr grid = make();
    return {grid, grid->memUsage()};
  });
}

/// Bricks made from a band that is wide enough for the cubic sampler.
void bricks(benchmark::State& state) {
  const bench::Threads threads(state.range(1));
  const LevelSet set = bake(*sphere(kCenter, kRadius), optionsOf(state, kCubicHalfWidth));
  constexpr double kBytesOfBrick = 5888.0;
  const FieldPtr field = bench::timed(state, [&] { return gridField(set); });
  const double count = static_cast<double>(memoryOf(*field)) / kBytesOfBrick;
  bench::perVoxel(state, set.info().active_voxels);
  state.counters["per_brick"] = benchmark::Counter(
      count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"R/h", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();
  for (const int threads : {1, 2}) {
    for (const int resolution : {100, 200, 400}) bench->Args({resolution, threads});
  }
}

void fewSizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"R/h", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();
  for (const int threads : {1, 2}) bench->Args({100, threads});
}

BENCHMARK(ball)->Name("ball/palpate")->Apply(sizes);
BENCHMARK(createLevelSetSphere)->Name("ball/createLevelSetSphere")->Apply(sizes);
BENCHMARK(csg)->Name("csg14/palpate")->Apply(sizes);
BENCHMARK(heartShape)->Name("heart/palpate")->Apply(fewSizes);
BENCHMARK(metaballPair)->Name("metaballs/palpate")->Apply(fewSizes);
BENCHMARK(gyroidBlock)->Name("gyroid/palpate")->Apply(fewSizes);
BENCHMARK(quadricEgg)->Name("quadric/palpate")->Apply(fewSizes);
BENCHMARK(bricks)->Name("bricks/palpate")->Apply(fewSizes);

}  // namespace
}  // namespace palpate::vdb
