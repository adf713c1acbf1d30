#pragma once
/// Samplers of other libraries on the same grid and path: each runs along the whole path once, for
/// value and gradient.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "palpate/vdb/level_set.h"

namespace palpate::bench {

/// A run returns a number that depends on every result.
struct Run {
  std::string sampler;
  /// Queries do not wait for each other.
  std::function<double(std::span<const Vec3>)> independent;
  /// Each position depends on the last result, by an amount too small to change it.
  std::function<double(std::span<const Vec3>)> dependent;
};

/// The factor of a result that `dependent` adds to a position.
inline constexpr double kNothing = 1e-40;

/// `sample(p)` returns an object with `value` and `gradient`.
template <class Sample>
Run makeRun(std::string sampler, Sample sample) {
  const auto total = [](const auto& s) {
    return static_cast<double>(s.value) + static_cast<double>(s.gradient[0]) +
           static_cast<double>(s.gradient[1]) + static_cast<double>(s.gradient[2]);
  };
  Run run;
  run.sampler = std::move(sampler);
  run.independent = [sample, total](std::span<const Vec3> path) mutable {
    double sum = 0.0;
    for (const Vec3& p : path) sum += total(sample(p));
    return sum;
  };
  run.dependent = [sample, total](std::span<const Vec3> path) mutable {
    double last = 0.0;
    for (const Vec3& p : path) last = total(sample(p + Vec3(kNothing * last)));
    return last;
  };
  return run;
}

/// BoxStencil with its own gradient; BoxSampler and QuadraticSampler with six differences.
[[nodiscard]] std::vector<Run> openvdbRuns(const vdb::LevelSet& grid);
/// Order 1 with its own gradient; orders 2 and 3 with six differences.
[[nodiscard]] std::vector<Run> nanovdbRuns(const vdb::LevelSet& grid);

inline constexpr const char* kYardstick = "OpenVDB BoxStencil";

}  // namespace palpate::bench
