// Stacks of layers against limits that need no integral, and bounds that hold for all.

#include "palpate/contact/layered.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "support/alloc_guard.h"

namespace palpate::test {
namespace {

constexpr double kRadius = 5e-3;

double felt(const std::vector<StackLayer>& layers) {
  return stackStiffness(layers, kRadius, false).stiffness;
}

TEST(StackStiffness, LayersOfOneStiffnessAreAHalfSpace) {
  EXPECT_EQ(felt({{400.0, 0.0}}), 400.0);
  for (const double thickness : {1e-5, 1e-3, 8e-3, 0.1}) {
    EXPECT_NEAR(felt({{400.0, thickness}, {400.0, 0.003}, {400.0, 0.0}}), 400.0, 1e-9);
  }
}

TEST(StackStiffness, ThickLayersHideAndThinOnesVanish) {
  EXPECT_NEAR(felt({{400.0, 50.0}, {8000.0, 0.0}}), 400.0, 1.0);
  EXPECT_NEAR(felt({{400.0, 1e-7}, {8000.0, 0.0}}), 8000.0, 0.01 * 8000.0);
  const double without = felt({{400.0, 0.01}, {900.0, 0.0}});
  EXPECT_NEAR(felt({{400.0, 0.01}, {5000.0, 1e-7}, {900.0, 0.0}}), without, 1e-3 * without);
}

/// Far below, a layer is under what a point force does, and the force it keeps from sinking is known: on an
/// incompressible layer of thickness h that sticks to a rigid ground a patch is stiffer than on a half-space
/// by 1 / (1 - c a / h). c is found twice, at two thicknesses, and must be the same.
TEST(StackStiffness, ADeepGroundShowsAsTheRadiusToTheDepth) {
  const auto c = [](double h) {
    const double rise = felt({{400.0, h}, {4e9, 0.0}}) / 400.0;
    return (1.0 - 1.0 / rise) * h / kRadius;
  };
  EXPECT_NEAR(c(50.0 * kRadius) / c(100.0 * kRadius), 1.0, 2e-3);
}

TEST(StackStiffness, LiesBetweenItsLayersAndGrowsWithEach) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> log_stiffness(5.0, 9.0);
  std::uniform_real_distribution<double> log_thickness(-8.0, -3.0);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<StackLayer> layers(2 + static_cast<std::size_t>(trial % 5));
    double least = 1e300;
    double most = 0.0;
    for (StackLayer& layer : layers) {
      layer = {std::exp(log_stiffness(random)), std::exp(log_thickness(random))};
      least = std::min(least, layer.stiffness);
      most = std::max(most, layer.stiffness);
    }
    const StackStiffness all = stackStiffness(layers, kRadius, true);
    ASSERT_GT(all.stiffness, 0.99 * least);
    ASSERT_LT(all.stiffness, 1.01 * most);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      std::vector<StackLayer> stiffer = layers;
      stiffer[i].stiffness *= 1.1;
      ASSERT_GE(felt(stiffer), all.stiffness * (1.0 - 1e-4)) << i;
      if (i + 1 == layers.size()) continue;
      const double h = 1e-3 * layers[i].thickness;
      std::vector<StackLayer> thicker = layers;
      std::vector<StackLayer> thinner = layers;
      thicker[i].thickness += h;
      thinner[i].thickness -= h;
      const double slope = (felt(thicker) - felt(thinner)) / (2.0 * h);
      // The rule's own error changes with the thickness where that is far below the radius.
      if (layers[i].thickness < 0.4 * kRadius || layers[0].thickness < 0.4 * kRadius) continue;
      ASSERT_NEAR(all.by_thickness[i], slope, 0.02 * std::fabs(slope) + 1e-4 * most / kRadius) << i;
    }
  }
}

TEST(StackStiffness, AllocatesNothing) {
  const std::vector<StackLayer> layers = {
      {400.0, 0.008}, {4000.0, 0.01}, {400.0, 0.02}, {9e3, 0.0}};
  const testing::AllocGuard guard;
  double sum = 0.0;
  for (int i = 0; i < 20; ++i) sum += stackStiffness(layers, kRadius, true).stiffness;
  EXPECT_EQ(guard.violations(), 0);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace palpate::test
