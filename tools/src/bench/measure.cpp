#include "bench/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>

namespace palpate::tools {
namespace {

using Clock = std::chrono::steady_clock;

/// Forces of less than this depth [m] are no forces: nothing can be said of their direction.
constexpr double kLeastDepth = 1e-6;
constexpr double kDegrees = 57.29577951308232;

struct Run {
  std::vector<TickResult> results;
  std::vector<std::int64_t> shortest;  ///< [ns] by tick
};

Run runPath(const ContactCase& what, HapticRenderer& renderer, int repeats,
            const Progress& progress) {
  const std::size_t n = what.path.size();
  Run run;
  run.results.resize(n);
  run.shortest.assign(n, std::numeric_limits<std::int64_t>::max());
  for (int repeat = 0; repeat < repeats; ++repeat) {
    report(progress, "running", static_cast<double>(repeat) / repeats);
    renderer.reset();
    Vec3 last = what.path.front();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 hip = what.path[i];
      const HipState state{hip, (hip - last) / kTickSeconds, kTickSeconds};
      last = hip;
      const auto before = Clock::now();
      run.results[i] = renderer.update(state);
      const auto after = Clock::now();
      const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(after - before).count();
      run.shortest[i] = std::min<std::int64_t>(run.shortest[i], ns);
    }
  }
  return run;
}

/// The smallest value that at least `share` of the sorted values do not exceed.
double quantile(const std::vector<std::int64_t>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return static_cast<double>(sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1]);
}

void time(const ContactCase& what, const Run& run, Measurement& out) {
  std::vector<std::int64_t> sorted(run.shortest.begin() + static_cast<std::ptrdiff_t>(what.first),
                                   run.shortest.begin() + static_cast<std::ptrdiff_t>(what.end));
  std::sort(sorted.begin(), sorted.end());
  out.ticks = sorted.size();
  out.median = quantile(sorted, 0.5);
  out.p99 = quantile(sorted, 0.99);
  out.p999 = quantile(sorted, 0.999);
  out.most = static_cast<double>(sorted.back());
}

double angleBetween(const Vec3& a, const Vec3& b) {
  return kDegrees * std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

void compare(const ContactCase& what, const Run& run, const Truth& truth, Measurement& out) {
  SpreadMeter direction;
  SpreadMeter magnitude;
  SpreadMeter error;
  bool every_tick = true;
  double true_step = 0.0;
  double true_turn = 0.0;
  for (std::size_t i = what.first; i < what.end; ++i) {
    const Vec3 force = run.results[i].force;
    const Vec3 before = i > 0 ? run.results[i - 1].force : Vec3(0.0);
    const double least = kWallStiffness * kLeastDepth;
    if (i > what.first) {
      out.step = std::max(out.step, glm::length(force - before));
      if (glm::length(force) > least && glm::length(before) > least) {
        out.turn = std::max(out.turn, angleBetween(force, before));
      }
    }
    if (!truth[i]) {
      every_tick = false;
      continue;
    }
    ++out.judged;
    const Vec3 expected = kWallStiffness * (*truth[i] - what.path[i]);
    const double size = glm::length(expected);
    const bool should = size > least;
    const bool does = glm::length(force) > least;
    if (should != does) ++out.missed;
    if (should) {
      magnitude.add((glm::length(force) - size) / size);
      error.add(glm::length(force - expected) / size);
      if (does) direction.add(angleBetween(force, expected));
    }
    if (i > what.first && truth[i - 1]) {
      const Vec3 expected_before = kWallStiffness * (*truth[i - 1] - what.path[i - 1]);
      true_step = std::max(true_step, glm::length(expected - expected_before));
      if (should && glm::length(expected_before) > least) {
        true_turn = std::max(true_turn, angleBetween(expected, expected_before));
      }
    }
  }
  if (every_tick) {
    out.true_step = true_step;
    out.true_turn = true_turn;
  }
  out.direction = direction.spread();
  out.magnitude = magnitude.spread();
  out.error = error.spread();
}

}  // namespace

std::optional<Measurement> measure(const ContactCase& what, RendererKind kind, int repeats,
                                   const Progress& progress, std::string& why) {
  std::unique_ptr<HapticRenderer> renderer;
  try {
    RendererSettings settings;
    settings.kind = kind;
    renderer = makeRenderer(what.scene, settings);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInput) throw;
    why = error.problem().message;
    return std::nullopt;
  }
  const Run run = runPath(what, *renderer, repeats, progress);
  Measurement out;
  time(what, run, out);
  compare(what, run, what.judge(what.path, run.results, progress), out);
  return out;
}

}  // namespace palpate::tools
