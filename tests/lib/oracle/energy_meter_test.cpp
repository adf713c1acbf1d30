#include "support/energy_meter.h"

#include <gtest/gtest.h>

namespace palpate::testing {
namespace {

// Rounding of sums of some hundred products of about 1e-3 J.
constexpr double kRounding = 1e-15;

TEST(EnergyMeter, ASampledSpringLeaksStiffnessTimesStepTimesDepth) {
  // The hand goes in by n equal steps and out again: F_k is held over the next step, so on the way
  // back each step gains the force of one step deeper; in total K step (x_n - x_0).
  const double stiffness = 1000.0;
  const double step = 1e-4;
  const int n = 20;
  EnergyMeter meter;
  for (int k = 0; k <= 2 * n; ++k) {
    const double depth = step * (k <= n ? k : 2 * n - k);
    meter.add(Vec3(0.0, 0.0, -depth), Vec3(0.0, 0.0, stiffness * depth));
  }
  EXPECT_NEAR(meter.work(), stiffness * step * step * n, kRounding);
  EXPECT_NEAR(meter.gained(), meter.work(), kRounding);
  // The energy stored on the way in is the sum of K (k step) step for k = 0 ... n - 1.
  const double stored = stiffness * step * step * n * (n - 1) / 2.0;
  EXPECT_NEAR(meter.rebound(), stored + meter.work(), kRounding);
}

TEST(EnergyMeter, DragOnlyTakes) {
  EnergyMeter meter;
  Vec3 last(0.0);
  for (int k = 1; k <= 100; ++k) {
    const Vec3 x(0.001 * k, 0.0, 0.0);
    meter.add(x, -2.0 * (x - last) / 0.001);
    last = x;
  }
  EXPECT_EQ(meter.gained(), 0.0);
  EXPECT_EQ(meter.rebound(), 0.0);
  EXPECT_NEAR(meter.work(), -2.0 * 0.099, kRounding * 100);
}

TEST(EnergyMeter, ATraceIsAddedRowByRow) {
  std::vector<TraceRow> rows(3);
  rows[0].result.force = Vec3(1.0, 0.0, 0.0);
  rows[1].hip = Vec3(0.5, 0.0, 0.0);
  rows[1].result.force = Vec3(0.0, 2.0, 0.0);
  rows[2].hip = Vec3(0.5, 0.25, 0.0);
  rows[2].result.force = Vec3(100.0);
  EXPECT_EQ(EnergyMeter::of(rows).work(), 1.0);
  EXPECT_EQ(EnergyMeter::of({}).work(), 0.0);
}

}  // namespace
}  // namespace palpate::testing
