#pragma once
/// What the benchmarks of baking share.

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

namespace palpate::vdb::bench {

/// [voxels] as in the measurements that others are known by.
inline constexpr double kHalfWidth = 3.0;

/// The run that touches no memory: what two threads can give here.
inline constexpr const char* kControl = "control";

/// Limits the threads while it lives.
class Threads {
 public:
  explicit Threads(std::int64_t count)
      : control_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)) {}

 private:
  tbb::global_control control_;
};

/// Adds the count of active voxels and the seconds that each took.
inline void perVoxel(benchmark::State& state, std::uint64_t voxels) {
  state.counters["voxels"] = static_cast<double>(voxels);
  state.counters["per_voxel"] = benchmark::Counter(
      static_cast<double>(voxels),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Times `make`, but not what it takes to free what the run before made.
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

/// What a run made: the thing itself, so that it stays there, and the memory [bytes] that it takes.
using Made = std::pair<std::shared_ptr<const void>, std::uint64_t>;

/// Runs `make` once more, untimed. Adds "memory_mb" of what it made, and "peak": the most memory
/// that was in use on the way, as a share of that.
void addPeak(benchmark::State& state, const std::function<Made()>& make);

}  // namespace palpate::vdb::bench
