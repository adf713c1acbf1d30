// Data that a touch keeps of its ticks in constant memory: order statistics of times, and rows for
// pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "quantile.h"
#include "thin_trace.h"
#include "tick_times.h"

namespace palpate::tools {
namespace {

TEST(TickTimes, QuantilesAreThoseOfAllTimes) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::lognormal_distribution<double> any(7.0, 0.1 + 0.1 * (seed % 30));
    TickTimes times;
    std::vector<std::int64_t> all;
    EXPECT_EQ(times.quantile(0.5), 0.0);
    const std::size_t count = 1 + random() % 3000;
    for (std::size_t i = 0; i < count; ++i) {
      all.push_back(std::llround(any(random)));
      times.add(all.back());
    }
    std::sort(all.begin(), all.end());
    for (const double share : {0.0, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const double exact = quantile(all, share);
      const double got = times.quantile(share);
      if (exact < 65536.0) {
        EXPECT_EQ(got, exact) << seed << " " << share;
      } else {
        EXPECT_GE(got, exact);
        EXPECT_LE(got, exact * (1.0 + 1.0 / 256.0)) << seed << " " << share;
      }
    }
    EXPECT_EQ(times.longest(), static_cast<double>(all.back()));
  }
}

TEST(ThinTrace, KeepsAllOfAShortTouchAndTheExtremesOfALongOne) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000},
                                  ThinTrace::kExact, ThinTrace::kExact + 1, std::size_t{400000}}) {
    std::mt19937 random(3);
    const auto any = [&] { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); };
    ThinTrace thin;
    Vec3 lowest(2.0);
    Vec3 highest(-2.0);
    double most = 0.0;
    std::vector<double> entered;
    Vec3 at(0.0);
    for (std::size_t n = 0; n < count; ++n) {
      at = 0.99 * at + 0.01 * Vec3(any(), any(), any());
      devices::RecordedTick tick;
      tick.tick.reading.time = static_cast<double>(n);
      tick.tick.hip.position = at;
      tick.tick.result.force = any() * Vec3(1.0, 0.0, 0.0);
      lowest = glm::min(lowest, at);
      highest = glm::max(highest, at);
      most = std::max(most, glm::length(tick.tick.result.force));
      RegionEntry entry;
      entry.force = static_cast<double>(n);
      const bool enters = random() % 50000 == 0;
      if (enters) entered.push_back(entry.force);
      thin.add(tick,
               enters ? std::span<const RegionEntry>(&entry, 1) : std::span<const RegionEntry>());
    }
    const Trace trace = thin.trace();
    const std::size_t rows = trace.rows().size();
    if (count <= ThinTrace::kExact) {
      EXPECT_EQ(rows, count);
    } else {
      EXPECT_GT(rows, ThinTrace::kMostStretches);
      EXPECT_LT(rows, 14 * ThinTrace::kMostStretches + 64);
    }
    if (count == 0) continue;
    EXPECT_EQ(trace.rows().front().t, 0.0);
    EXPECT_EQ(trace.rows().back().t, static_cast<double>(count - 1));
    Vec3 low(2.0);
    Vec3 high(-2.0);
    double peak = 0.0;
    std::vector<double> kept;
    double before = -1.0;
    for (const TraceRow& row : trace.rows()) {
      EXPECT_GT(row.t, before);
      before = row.t;
      low = glm::min(low, row.hip);
      high = glm::max(high, row.hip);
      peak = std::max(peak, glm::length(row.result.force));
      for (const RegionEntry& entry : trace.entriesOf(row)) kept.push_back(entry.force);
    }
    EXPECT_EQ(low, lowest);
    EXPECT_EQ(high, highest);
    EXPECT_EQ(peak, most);
    EXPECT_EQ(kept, entered);
  }
}

}  // namespace
}  // namespace palpate::tools
