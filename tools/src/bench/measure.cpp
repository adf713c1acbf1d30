#include "bench/measure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bench/run_path.h"
#include "quantile.h"

namespace palpate::tools {
namespace {

/// [m] A force from a smaller depth does not count, because its direction is uncertain.
constexpr double kLeastDepth = 1e-6;
constexpr double kDegrees = 57.29577951308232;

HotTimes hotTimes(const ContactCase& what, const HotRun& run) {
  std::vector<std::int64_t> sorted(run.shortest.begin() + static_cast<std::ptrdiff_t>(what.first),
                                   run.shortest.begin() + static_cast<std::ptrdiff_t>(what.end));
  std::sort(sorted.begin(), sorted.end());
  return {quantile(sorted, 0.5), quantile(sorted, 0.99), quantile(sorted, 0.999),
          quantile(sorted, 1.0)};
}

OnceTimes onceTimes(std::vector<std::int64_t> ns) {
  std::sort(ns.begin(), ns.end());
  return {ns.size(), quantile(ns, 0.5), quantile(ns, 0.999)};
}

double angleBetween(const Vec3& a, const Vec3& b) {
  return kDegrees * std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

void compare(const ContactCase& what, const HotRun& run, const Truth& truth, Measurement& out) {
  SpreadMeter direction;
  SpreadMeter magnitude;
  SpreadMeter error;
  Judgement judgement;
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
    ++judgement.ticks;
    const Vec3 expected = kWallStiffness * (*truth[i] - what.path[i]);
    const double size = glm::length(expected);
    const bool should = size > least;
    const bool does = glm::length(force) > least;
    if (should != does) ++judgement.missed;
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
  if (judgement.ticks == 0) return;
  judgement.direction = direction.found();
  judgement.magnitude = magnitude.found();
  judgement.error = error.found();
  out.judgement = judgement;
}

}  // namespace

std::optional<Measurement> measure(const ContactCase& what, RendererKind kind,
                                   const MeasureSettings& settings, CacheFlood* flood,
                                   const Progress& progress, std::string& why) {
  std::unique_ptr<HapticRenderer> renderer;
  try {
    RendererSettings renderer_settings;
    renderer_settings.kind = kind;
    renderer = makeRenderer(what.scene, renderer_settings);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInput) throw;
    why = error.problem().message;
    return std::nullopt;
  }
  const HotRun run = runHot(what, *renderer, settings.repeats, progress);
  Measurement out;
  out.ticks = what.end - what.first;
  out.hot = hotTimes(what, run);
  if (settings.paced_ticks > 0) {
    out.paced = onceTimes(runPaced(what, *renderer, settings.paced_ticks, progress));
  }
  if (settings.cold_ticks > 0) {
    out.cold = onceTimes(runCold(what, *renderer, settings.cold_ticks, *flood, progress));
  }
  if (kind == RendererKind::kConstraint) {
    out.unsettled.emplace();
    for (std::size_t i = what.first; i < what.end; ++i) {
      out.unsettled->add(run.results[i].settled);
    }
  }
  compare(what, run, what.judge(what.path, run.results, progress), out);
  return out;
}

}  // namespace palpate::tools
