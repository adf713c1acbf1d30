#include "palpate/devices/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace palpate::devices {
namespace {

TEST(LatencyHistogram, QuantilesAreThoseOfTheSortedTimesToAnEighth) {
  const unsigned seed = 12;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> exponent(0.0, 10.0);
  for (const std::size_t count : {1U, 2U, 10U, 1000U, 20'000U}) {
    LatencyHistogram histogram;
    std::vector<std::int64_t> times;
    for (std::size_t i = 0; i < count; ++i) {
      times.push_back(std::llround(std::pow(10.0, exponent(random))));
      histogram.add(times.back());
    }
    std::sort(times.begin(), times.end());
    EXPECT_EQ(histogram.count(), count);
    EXPECT_EQ(histogram.longest(), times.back());
    for (const double share : {0.0, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const double wanted = std::ceil(share * static_cast<double>(count));
      const auto rank = static_cast<std::size_t>(std::max(1.0, wanted));
      const auto truth = static_cast<double>(times[rank - 1]);
      const auto told = static_cast<double>(histogram.quantile(share));
      EXPECT_GE(told, truth);
      EXPECT_LE(told, truth * 1.125);
    }
  }
}

TEST(LatencyHistogram, TakesWhateverATimeMayBe) {
  LatencyHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0);
  histogram.add(-5);
  EXPECT_EQ(histogram.quantile(1.0), 0);
  histogram.add(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram.quantile(1.0), std::numeric_limits<std::int64_t>::max());
  for (std::int64_t ns = 0; ns < 8; ++ns) {
    LatencyHistogram one;
    one.add(ns);
    EXPECT_EQ(one.quantile(0.5), ns);
  }
}

}  // namespace
}  // namespace palpate::devices
