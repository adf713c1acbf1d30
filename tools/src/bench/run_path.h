#pragma once
/// Runs a renderer along a case's path and measures its times: hot, at the pace of a device, and
/// cold.

#include <cstdint>
#include <vector>

#include "bench/contact_case.h"
#include "cache_flood.h"

namespace palpate::tools {

/// The whole path, tick after tick without waiting.
struct HotRun {
  std::vector<TickResult> results;
  std::vector<std::int64_t> shortest;  ///< [ns] shortest time of each tick over all repetitions
};
[[nodiscard]] HotRun runHot(const ContactCase& what, HapticRenderer& renderer, int repeats,
                            const Progress& progress);

/// [ns] Times of about `wanted` ticks that begin kTickSeconds after one another, as in a servo
/// loop, in stretches spread over the judged part of the path. The loop sleeps in between, so that
/// the caches hold what other work of the machine left there.
[[nodiscard]] std::vector<std::int64_t> runPaced(const ContactCase& what, HapticRenderer& renderer,
                                                 int wanted, const Progress& progress);

/// [ns] Times of about `wanted` ticks spread over the judged part, each after `flood`.
[[nodiscard]] std::vector<std::int64_t> runCold(const ContactCase& what, HapticRenderer& renderer,
                                                int wanted, CacheFlood& flood,
                                                const Progress& progress);

}  // namespace palpate::tools
