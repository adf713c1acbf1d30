// Labels -> smooth distances, beside OpenVDB's topologyToLevelSet in the same run.
#include <openvdb/tools/TopologyToLevelSet.h>

#include "bench/bake_bench.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/scan_surface.h"

namespace palpate::vdb::bench {
namespace {

constexpr double kMm = 1e-3;

/// A ball of label 1 in voxels of 1 mm.
Image ballImage(int radius) {
  const int side = 2 * radius + 15;
  const Vec3 center(side / 2.0 + 0.13, side / 2.0 - 0.29, side / 2.0 + 0.37);
  Image image;
  image.size = {side, side, side};
  image.axes = Mat3(kMm);
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        image.values.push_back(glm::length(Vec3(i, j, k) - center) < radius ? 1.0F : 0.0F);
      }
    }
  }
  return image;
}

void labels(benchmark::State& state) {
  const Threads threads(state.range(1));
  const Image image = ballImage(static_cast<int>(state.range(0)));
  std::uint64_t voxels = 0;
  for (auto _ : state) {
    const LevelSet grid = surfaceFromLabels(image, {.values = {1}}, {});
    voxels = grid.info().active_voxels;
  }
  perVoxel(state, voxels);
}

void topologyToLevelSet(benchmark::State& state) {
  const Threads threads(state.range(1));
  const Image image = ballImage(static_cast<int>(state.range(0)));
  initializeOpenVdb();
  auto mask = openvdb::MaskGrid::create();
  auto accessor = mask->getAccessor();
  std::size_t n = 0;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i, ++n) {
        if (image.values[n] > 0.0F) accessor.setValueOn(openvdb::Coord(i, j, k));
      }
    }
  }
  std::uint64_t voxels = 0;
  constexpr int kWidth = 6;
  constexpr int kSmoothing = 4;
  for (auto _ : state) {
    const auto grid = openvdb::tools::topologyToLevelSet(*mask, kWidth, 1, 0, kSmoothing);
    voxels = grid->activeVoxelCount();
  }
  perVoxel(state, voxels);
}

BENCHMARK(labels)
    ->ArgNames({"radius", "threads"})
    ->Args({25, 1})
    ->Args({60, 1})
    ->Args({60, 2})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK(topologyToLevelSet)
    ->ArgNames({"radius", "threads"})
    ->Args({25, 1})
    ->Args({60, 1})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace palpate::vdb::bench
