#pragma once
/// Shared by the benchmarks of baking.

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

namespace palpate::vdb::bench {

/// [voxels] the half width that published measurements of others use
inline constexpr double kHalfWidth = 3.0;

/// The run that touches no memory: it shows the speed-up that two threads can reach here.
inline constexpr const char* kControl = "control";

/// Limits the number of threads while it exists.
class Threads {
 public:
  explicit Threads(std::int64_t count)
      : control_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)) {}

 private:
  tbb::global_control control_;
};

/// Adds the count of active voxels and the seconds for each of them.
inline void perVoxel(benchmark::State& state, std::uint64_t voxels) {
  state.counters["voxels"] = static_cast<double>(voxels);
  state.counters["per_voxel"] = benchmark::Counter(
      static_cast<double>(voxels),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Times `make`, but not the release of the previous result.
template <class Make>
auto timed(benchmark::State& state, const Make& make) {
  decltype(make()) made{};
  for (auto run : state) {
    state.PauseTiming();
    made = {};
    state.ResumeTiming();
    made = make();
  }
  return made;
}

/// The result of a run: the object itself, so that it stays allocated, and the memory [bytes] that
/// it takes.
using Made = std::pair<std::shared_ptr<const void>, std::uint64_t>;

/// Runs `make` once more, untimed. Adds "memory_mb", the memory of its result, and "peak", the
/// largest memory in use meanwhile as a multiple of it.
void addPeak(benchmark::State& state, const std::function<Made()>& make);

}  // namespace palpate::vdb::bench
