// The best speed-up that two threads reach on this machine: work that touches no memory, divided as
// a bake is. If other programs use the cores, or the clock drops when both are busy, the speed-up
// is less than 2, and so it is for a bake.

#include <benchmark/benchmark.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "bench/bake_bench.h"

namespace palpate::vdb {
namespace {

void compute(benchmark::State& state) {
  const bench::Threads threads(state.range(0));
  constexpr std::size_t kPieces = 4096;
  for (auto run : state) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, kPieces), [](const auto& range) {
      double sum = 0.0;
      for (std::size_t piece = range.begin(); piece != range.end(); ++piece) {
        // Each step waits for the last, some 3 ns.
        for (int n = 0; n < 2000; ++n) sum = sum * 0.999 + static_cast<double>(piece);
      }
      benchmark::DoNotOptimize(sum);
    });
  }
}

BENCHMARK(compute)
    ->Name(bench::kControl)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace palpate::vdb
