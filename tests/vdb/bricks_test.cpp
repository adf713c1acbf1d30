// Bricks compared with a plain evaluation of the same spline, on noise: a voxel taken from a wrong
// place shows at once. Also checks continuity at borders.

#include "brick/bricks.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "brick/brick_field.h"
#include "palpate/core/error.h"
#include "support/field_contract.h"
#include "vdb/noise_grid.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using openvdb::Coord;
using palpate::test::Random;

constexpr double kVoxel = kNoiseVoxel;

/// The coefficient of one voxel by the formula in prefilter.h, term by term.
double coefficient(const Coord& at) {
  const auto f = [&](int axis, int steps, int other = 0, int other_steps = 0) {
    Coord to = at;
    to[axis] += steps;
    to[other] += other_steps;
    return noise(to.x(), to.y(), to.z());
  };
  const double here = f(0, 0);
  double c = here;
  for (int a = 0; a < 3; ++a) {
    c -= (f(a, 1) + f(a, -1) - 2.0 * here) / 6.0;
    const double fourth = f(a, 2) - 4.0 * f(a, 1) + 6.0 * here - 4.0 * f(a, -1) + f(a, -2);
    c += fourth * (1.0 / 36.0 + 1.0 / 720.0);
    for (int b = a + 1; b < 3; ++b) {
      const auto row = [&](int step) {
        return f(a, 1, b, step) - 2.0 * f(b, step) + f(a, -1, b, step);
      };
      const double middle = f(a, 1) - 2.0 * here + f(a, -1);
      c += (row(1) - 2.0 * middle + row(-1)) / 36.0;
    }
  }
  return c;
}

/// The cubic B-spline about 0, and its derivatives.
double basis(double x, int derivative) {
  const double a = std::abs(x);
  const double sign = x < 0.0 ? -1.0 : 1.0;
  if (a >= 2.0) return 0.0;
  const double rest = 2.0 - a;
  if (derivative == 0) {
    return a < 1.0 ? 2.0 / 3.0 - a * a + 0.5 * a * a * a : rest * rest * rest / 6.0;
  }
  if (derivative == 1) return sign * (a < 1.0 ? -2.0 * a + 1.5 * a * a : -0.5 * rest * rest);
  return a < 1.0 ? -2.0 + 3.0 * a : rest;
}

/// Value in voxels, derivatives per voxel; `orders` are the orders of derivatives along the axes.
double spline(const Vec3& q, const std::array<int, 3>& orders) {
  const Coord base = Coord::floor(openvdb::Vec3d(q.x, q.y, q.z));
  double sum = 0.0;
  for (int n = 0; n < 64; ++n) {
    const Coord at = base.offsetBy(n / 16 - 1, n / 4 % 4 - 1, n % 4 - 1);
    double weight = 1.0;
    for (int a = 0; a < 3; ++a) weight *= basis(q[a] - at[a], orders[static_cast<std::size_t>(a)]);
    sum += weight * coefficient(at);
  }
  return sum;
}

// Coefficients are floats of up to 6 voxels, rounded by 2.4e-7 each, and added with weights of up
// to 1, 3 and 8.
constexpr double kRounding = 1e-6;

void expectIsSpline(const Field& field, const Vec3& q) {
  const FieldJet jet = field.jet(kVoxel * q);
  const FieldSample sample = field.sample(kVoxel * q);
  ASSERT_TRUE(jet.in_band);
  ASSERT_TRUE(sample.in_band);
  ASSERT_NEAR(sample.value / kVoxel, spline(q, {0, 0, 0}), kRounding);
  ASSERT_NEAR(jet.value / kVoxel, sample.value / kVoxel, 1e-13);
  for (int a = 0; a < 3; ++a) {
    std::array<int, 3> orders{};
    ++orders[static_cast<std::size_t>(a)];
    ASSERT_NEAR(sample.gradient[a], spline(q, orders), 3.0 * kRounding);
    ASSERT_NEAR(jet.gradient[a], sample.gradient[a], 1e-13);
    for (int b = 0; b < 3; ++b) {
      std::array<int, 3> twice = orders;
      ++twice[static_cast<std::size_t>(b)];
      ASSERT_NEAR(jet.hessian[a][b] * kVoxel, spline(q, twice), 8.0 * kRounding) << a << b;
    }
  }
}

TEST(Bricks, AreTheSplineOfTheirFormulaInEveryInstructionSet) {
  const LevelSet grid = noiseGrid({Coord(0), Coord(128, -128, 0)}, 14);
  for (const InstructionSet set : instructionSets()) {
    const BrickField field(grid, Sampler::kCubic, set);
    EXPECT_EQ(field.bricks().view().coarse, nullptr);
    Random random(3);
    for (int i = 0; i < 200; ++i) {
      const Vec3 center = i % 2 == 0 ? Vec3(0.0) : Vec3(128.0, -128.0, 0.0);
      const Vec3 half(9.0);
      expectIsSpline(field, center + random.in({-half, half}));
    }
  }
}

TEST(Bricks, ATableOfTwoLevelsFindsTheSame) {
  const Vec3 far(-6000.0, 4000.0, 2000.0);
  const LevelSet grid = noiseGrid({Coord(0), Coord(-6000, 4000, 2000)}, 14);
  const BrickField field(grid);
  ASSERT_NE(field.bricks().view().coarse, nullptr);
  // A flat table of these 94 million blocks would take 375 MB.
  EXPECT_LT(field.bricks().memory(), 4'000'000U);
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vec3 half(9.0);
    expectIsSpline(field, (i % 2 == 0 ? Vec3(0.0) : far) + random.in({-half, half}));
  }
  // Between the two cubes there are no voxels: such a place is outside.
  const FieldSample between = field.sample(0.5 * far * kVoxel);
  EXPECT_FALSE(between.in_band);
  EXPECT_GT(between.value, 5.0 * kVoxel);
}

TEST(Bricks, RefuseATableWithoutEnd) {
  try {
    const Bricks bricks(noiseGrid({Coord(0), Coord(-400000, 300000, 200000)}, 2), Sampler::kCubic);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "bricks.extent");
    EXPECT_NE(error.problem().hint.find("accessor"), std::string::npos);
  }
}

/// Value, gradient and Hessian on both sides of faces, edges and corners of cells, leaves, and
/// nodes of 128 voxels. The points are a billionth of a voxel apart, and third derivatives of the
/// noise are below 100.
TEST(Bricks, AreTwiceDifferentiableAcrossEveryBorder) {
  const BrickField field(noiseGrid({Coord(0), Coord(128), Coord(-128, 128, 8)}, 14));
  Random random(5);
  constexpr double kStep = 1e-9;
  int checked = 0;
  for (const Vec3& center : {Vec3(0.0), Vec3(128.0), Vec3(-128.0, 128.0, 8.0)}) {
    for (const double border : {0.0, -8.0, 8.0, 1.0, -3.0}) {
      for (int axes = 1; axes < 8; ++axes) {
        for (int i = 0; i < 20; ++i, ++checked) {
          Vec3 at = center + random.in({Vec3(-8.5), Vec3(8.5)});
          Vec3 step(0.0);
          for (int a = 0; a < 3; ++a) {
            if ((axes >> a & 1) == 0) continue;
            at[a] = center[a] + border;
            step[a] = kStep;
          }
          const FieldJet before = field.jet(kVoxel * (at - step));
          const FieldJet after = field.jet(kVoxel * (at + step));
          ASSERT_TRUE(before.in_band && after.in_band);
          // The same coefficients on either side, so that only rounding of sums differs.
          ASSERT_NEAR(before.value / kVoxel, after.value / kVoxel, 1e-7);
          for (int a = 0; a < 3; ++a) {
            ASSERT_NEAR(before.gradient[a], after.gradient[a], 1e-6);
            for (int b = 0; b < 3; ++b) {
              ASSERT_NEAR(before.hessian[a][b] * kVoxel, after.hessian[a][b] * kVoxel, 1e-6);
            }
          }
        }
      }
    }
  }
  EXPECT_EQ(checked, 2100);
}

/// A cell is known if its 64 coefficients are; a coefficient is known if its voxel and the six
/// neighbors are.
TEST(Bricks, AreKnownWhereAllVoxelsAre) {
  const BrickField cubic(noiseGrid({Coord(3)}, 9));  // voxels -6 to 11
  const BrickField linear(noiseGrid({Coord(3)}, 9), Sampler::kTrilinear);
  const auto known = [](const Vec3& q, int below, int above) {
    bool all = true;
    for (int a = 0; a < 3; ++a) {
      const double base = std::floor(q[a]);
      all = all && base - below >= -6.0 && base + above <= 11.0;
    }
    return all;
  };
  Random random(6);
  int in = 0, out = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 q = random.in({Vec3(-12.0), Vec3(17.0)});
    const FieldSample sample = cubic.sample(kVoxel * q);
    ASSERT_EQ(sample.in_band, known(q, 2, 3));
    ASSERT_EQ(linear.sample(kVoxel * q).in_band, known(q, 0, 1));
    ++(sample.in_band ? in : out);
    if (!sample.in_band) {
      ASSERT_EQ(sample.gradient, Vec3(0.0));
    }
  }
  EXPECT_GT(in, 1000);
  EXPECT_GT(out, 1000);
}

}  // namespace
}  // namespace palpate::vdb
