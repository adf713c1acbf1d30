// Stacks of layers against limits that need no integral, and against bounds that hold for all.

#include "palpate/contact/layered.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "support/alloc_guard.h"

namespace palpate::test {
namespace {

constexpr double kRadius = 5e-3;

double felt(const std::vector<StackLayer>& layers) {
  return stackStiffness(layers, kRadius).stiffness;
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

/// A ground far below a layer feels only a point force, whose reduced compliance is known: on an
/// incompressible layer of thickness h that sticks to a rigid ground, a patch is stiffer than on a
/// half-space by 1 / (1 - c a / h). c is computed at two thicknesses, and must be the same.
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
    const StackStiffness all = stackStiffness(layers, kRadius);
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
      // Where a thickness is far below the radius, the error of the quadrature itself changes with
      // it.
      if (layers[i].thickness < 0.4 * kRadius || layers[0].thickness < 0.4 * kRadius) continue;
      ASSERT_NEAR(all.by_thickness[i], slope, 0.02 * std::fabs(slope) + 1e-4 * most / kRadius) << i;
    }
  }
}

struct Mat {
  double a, b, c, d;  // [[a, b], [c, d]]
};

Mat product(const Mat& x, const Mat& y) {
  return {x.a * y.a + x.b * y.c, x.a * y.b + x.b * y.d, x.c * y.a + x.d * y.c,
          x.c * y.b + x.d * y.d};
}

Mat inverse(const Mat& x) {
  const double f = 1.0 / (x.a * x.d - x.b * x.c);
  return {f * x.d, -f * x.b, -f * x.c, f * x.a};
}

/// The compliance of the stack beyond that of its top layer alone, as a share of the latter, at
/// wave number k. It is computed without reflections: the material below a plane resists a
/// displacement u there by 2 k Y u, and a layer turns Y at its lower side into Y at its upper side.
double excess(const std::vector<StackLayer>& layers, double k) {
  const double last = layers.back().stiffness;
  Mat y{last, 0.0, 0.0, last};
  for (std::size_t i = layers.size() - 1; i-- > 0;) {
    const double mu = layers[i].stiffness;
    const double s = k * layers[i].thickness;
    const double e = std::exp(-s);
    const Mat down{e * (1.0 - s), e * s, -e * s, e * (1.0 + s)};
    const Mat up{down.a, -down.b, -down.c, down.d};
    const Mat back =
        product(inverse({mu + y.a, y.b, y.c, mu + y.d}), {mu - y.a, -y.b, -y.c, mu - y.d});
    const Mat q = product(up, product(back, down));
    const Mat out =
        product({1.0 - q.a, -q.b, -q.c, 1.0 - q.d}, inverse({1.0 + q.a, q.b, q.c, 1.0 + q.d}));
    y = {mu * out.a, mu * out.b, mu * out.c, mu * out.d};
  }
  return layers.front().stiffness * inverse(y).d - 1.0;
}

/// The integral over all waves by Simpson's rule in small steps.
double byIntegral(const std::vector<StackLayer>& layers) {
  const auto f = [&](double x) {
    const double sinc = std::sin(x) / x;
    return sinc * sinc * excess(layers, x / kRadius);
  };
  constexpr double kEnd = 200.0;
  double sum = 0.0;
  for (double from = 1e-5; from < kEnd;) {
    const double to = std::min({from * 1.1, from + 0.2, kEnd});
    sum += (to - from) / 6.0 * (f(from) + 4.0 * f(0.5 * (from + to)) + f(to));
    from = to;
  }
  sum += 0.5 / kEnd * excess(layers, kEnd / kRadius);  // the mean of sin^2 is a half
  return layers.front().stiffness / (1.0 + 2.0 / std::numbers::pi * sum);
}

TEST(StackStiffness, IsTheIntegralOverTheWaves) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> log_stiffness(5.0, 9.0);
  std::uniform_real_distribution<double> log_thickness(-7.5, -2.5);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<StackLayer> layers(2 + static_cast<std::size_t>(trial % 5));
    for (StackLayer& layer : layers) {
      layer = {std::exp(log_stiffness(random)), std::exp(log_thickness(random))};
    }
    const double expected = byIntegral(layers);
    // Sixteen waves approximate the integral.
    ASSERT_NEAR(felt(layers), expected, 4e-3 * expected) << trial;
  }
}

TEST(StackStiffness, ItsDerivativesAreItsOwn) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> log_stiffness(5.0, 9.0);
  std::uniform_real_distribution<double> log_thickness(-8.0, -3.0);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<StackLayer> layers(2 + static_cast<std::size_t>(trial % 5));
    for (StackLayer& layer : layers) {
      layer = {std::exp(log_stiffness(random)), std::exp(log_thickness(random))};
    }
    const StackStiffness all = stackStiffness(layers, kRadius);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const auto slope = [&](double StackLayer::*member) {
        const double h = 1e-5 * layers[i].*member;
        std::vector<StackLayer> more = layers;
        std::vector<StackLayer> less = layers;
        more[i].*member += h;
        less[i].*member -= h;
        return (felt(more) - felt(less)) / (2.0 * h);
      };
      ASSERT_NEAR(all.by_stiffness[i], slope(&StackLayer::stiffness), 1e-6) << trial;
      const double by_thickness = slope(&StackLayer::thickness);
      ASSERT_NEAR(all.by_thickness[i], by_thickness,
                  1e-5 * (std::fabs(by_thickness) + all.stiffness / layers[i].thickness))
          << trial;
    }
  }
}

TEST(StackStiffness, AllocatesNothing) {
  const std::vector<StackLayer> layers = {
      {400.0, 0.008}, {4000.0, 0.01}, {400.0, 0.02}, {9e3, 0.0}};
  const testing::AllocGuard guard;
  double sum = 0.0;
  for (int i = 0; i < 20; ++i) sum += stackStiffness(layers, kRadius).stiffness;
  EXPECT_EQ(guard.violations(), 0);
  EXPECT_GT(sum, 0.0);
}

TEST(StackStiffness, OfOneLayerIsTheLayersOwn) {
  const std::array<StackLayer, 1> one = {StackLayer{700.0, 0.0}};
  const StackStiffness all = stackStiffness(one, kRadius);
  EXPECT_EQ(all.stiffness, 700.0);
  EXPECT_EQ(all.by_stiffness[0], 1.0);
  EXPECT_EQ(all.by_thickness[0], 0.0);
}

}  // namespace
}  // namespace palpate::test
