#include "bench/run_path.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

namespace palpate::tools {
namespace {

using Clock = std::chrono::steady_clock;

/// A servo loop wakes this much early and then watches the clock until the tick is due.
constexpr std::chrono::microseconds kSpin(80);
constexpr std::size_t kStretches = 10;

/// Plays the path from its first point; calls `before` with each tick's index before the timed
/// update.
template <typename Before, typename After>
void play(const ContactCase& what, HapticRenderer& renderer, const Before& before,
          const After& after) {
  renderer.reset();
  Vec3 last = what.path.front();
  for (std::size_t i = 0; i < what.path.size(); ++i) {
    const Vec3 hip = what.path[i];
    const HipState state{hip, (hip - last) / kTickSeconds, kTickSeconds};
    last = hip;
    before(i);
    const auto began = Clock::now();
    const TickResult result = renderer.update(state);
    const auto ended = Clock::now();
    const std::int64_t ns =
        std::chrono::duration_cast<std::chrono::nanoseconds>(ended - began).count();
    after(i, result, ns);
  }
}

}  // namespace

HotRun runHot(const ContactCase& what, HapticRenderer& renderer, int repeats,
              const Progress& progress) {
  const std::size_t n = what.path.size();
  HotRun run;
  run.results.resize(n);
  run.shortest.assign(n, std::numeric_limits<std::int64_t>::max());
  for (int repeat = 0; repeat < repeats; ++repeat) {
    report(progress, "running", static_cast<double>(repeat) / repeats);
    play(
        what, renderer, [](std::size_t) {},
        [&](std::size_t i, const TickResult& result, std::int64_t ns) {
          run.results[i] = result;
          run.shortest[i] = std::min(run.shortest[i], ns);
        });
  }
  return run;
}

std::vector<std::int64_t> runPaced(const ContactCase& what, HapticRenderer& renderer, int wanted,
                                   const Progress& progress) {
  const std::size_t ticks = what.end - what.first;
  const std::size_t stretch = std::max<std::size_t>(ticks / kStretches, 1);
  const std::size_t paced =
      std::clamp<std::size_t>(static_cast<std::size_t>(wanted) / kStretches, 1, stretch);
  constexpr auto kTick =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kTickSeconds));
  std::vector<std::int64_t> out;
  Clock::time_point due = Clock::now();
  const auto isPaced = [&](std::size_t i) {
    return i >= what.first && i < what.end && (i - what.first) % stretch < paced;
  };
  play(
      what, renderer,
      [&](std::size_t i) {
        if (!isPaced(i)) return;
        // As a device does: a tick that begins late does not delay the schedule of later ticks.
        const bool is_first = (i - what.first) % stretch == 0;
        due = is_first ? Clock::now() + kTick : std::max(due + kTick, Clock::now());
        if ((i - what.first) % 64 == 0) report(progress, "at the pace of a device", -1.0);
        std::this_thread::sleep_until(due - kSpin);
        while (Clock::now() < due) {
        }
      },
      [&](std::size_t i, const TickResult&, std::int64_t ns) {
        if (isPaced(i)) out.push_back(ns);
      });
  return out;
}

std::vector<std::int64_t> runCold(const ContactCase& what, HapticRenderer& renderer, int wanted,
                                  CacheFlood& flood, const Progress& progress) {
  const std::size_t stride =
      std::max<std::size_t>((what.end - what.first) / static_cast<std::size_t>(wanted), 1);
  std::vector<std::int64_t> out;
  const auto isCold = [&](std::size_t i) {
    return i >= what.first && i < what.end && (i - what.first) % stride == stride / 2;
  };
  play(
      what, renderer,
      [&](std::size_t i) {
        if (!isCold(i)) return;
        report(progress, "after other data in the caches", -1.0);
        flood.run();
      },
      [&](std::size_t i, const TickResult&, std::int64_t ns) {
        if (isCold(i)) out.push_back(ns);
      });
  return out;
}

}  // namespace palpate::tools
