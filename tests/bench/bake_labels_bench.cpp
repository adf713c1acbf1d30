// Baking a ball of labels to a band, compared with OpenVDB's topologyToLevelSet.

#include <benchmark/benchmark.h>
#include <openvdb/tools/TopologyToLevelSet.h>

#include "bench/bake_bench.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/scan_surface.h"

namespace palpate::vdb {
namespace {

constexpr double kSpacing = 1e-3;  // [m]

bool isInside(int i, int j, int k, int radius) {
  const double x = i - radius - 8.31, y = j - radius - 8.17, z = k - radius - 8.23;
  return x * x + y * y + z * z < static_cast<double>(radius) * radius;
}

int sideOf(int radius) { return 2 * radius + 17; }

void ours(benchmark::State& state) {
  const auto radius = static_cast<int>(state.range(0));
  const bench::Threads threads(state.range(1));
  Image image;
  image.size.fill(sideOf(radius));
  image.axes = Mat3(kSpacing);
  for (int k = 0; k < sideOf(radius); ++k) {
    for (int j = 0; j < sideOf(radius); ++j) {
      for (int i = 0; i < sideOf(radius); ++i) {
        image.values.push_back(isInside(i, j, k, radius) ? 1.0F : 0.0F);
      }
    }
  }
  BakeOptions bake;
  bake.voxel_size = kSpacing;
  bake.half_width = bench::kHalfWidth;
  const auto make = [&] { return surfaceFromLabels(image, {.values = {1}}, bake); };
  bench::perVoxel(state, bench::timed(state, make).info().active_voxels);
  bench::addPeak(state, [&]() -> bench::Made {
    const auto set = std::make_shared<const LevelSet>(make());
    return {set, set->info().memory};
  });
}

void topologyToLevelSet(benchmark::State& state) {
  openvdb::initialize();
  const auto radius = static_cast<int>(state.range(0));
  const bench::Threads threads(state.range(1));
  openvdb::MaskGrid mask;
  auto to = mask.getAccessor();
  for (int i = 0; i < sideOf(radius); ++i) {
    for (int j = 0; j < sideOf(radius); ++j) {
      for (int k = 0; k < sideOf(radius); ++k) {
        if (isInside(i, j, k, radius)) to.setValueOn({i, j, k});
      }
    }
  }
  const auto make = [&] {
    constexpr int kSmoothing = 1;
    return openvdb::tools::topologyToLevelSet(mask, static_cast<int>(bench::kHalfWidth), 0, 0,
                                              kSmoothing);
  };
  bench::perVoxel(state, bench::timed(state, make)->activeVoxelCount());
  bench::addPeak(state, [&]() -> bench::Made {
    const openvdb::FloatGrid::Ptr grid = make();
    return {grid, grid->memUsage()};
  });
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"R/h", "threads"})->Unit(benchmark::kMillisecond)->UseRealTime();
  for (const int radius : {25, 50}) bench->Args({radius, 1});
  bench->Args({50, 2});
}

BENCHMARK(ours)->Name("labels/palpate")->Apply(sizes);
BENCHMARK(topologyToLevelSet)->Name("labels/topologyToLevelSet")->Apply(sizes);

}  // namespace
}  // namespace palpate::vdb
