// Bricks against a plain evaluation of the same spline, on noise: a voxel that is taken from a wrong place
// shows at once. And what holds at borders, in every instruction set, from several threads.

#include "brick/bricks.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <thread>
#include <vector>

#include "brick/brick_field.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/openvdb_access.h"
#include "support/field_contract.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using openvdb::Coord;
using palpate::test::Random;

constexpr double kVoxel = 0.5e-3;  // [m]

/// [voxels] One number for each voxel, from -3 to 3.
double noise(int x, int y, int z) {
  std::uint64_t bits = 0x9E3779B97F4A7C15ULL;
  for (const int i : {x, y, z}) {
    bits = (bits ^ static_cast<std::uint32_t>(i)) * 0xBF58476D1CE4E5B9ULL;
    bits ^= bits >> 29;
  }
  const double share = static_cast<double>(bits >> 40) / static_cast<double>(1 << 24);
  return static_cast<float>((6.0 * share - 3.0) * kVoxel * 1e3) / (kVoxel * 1e3);
}

/// Noise in cubes of 2 * `half` voxels about `centers`; nothing elsewhere.
LevelSet noiseGrid(const std::vector<Coord>& centers, int half) {
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(static_cast<float>(6.0 * kVoxel * 1e3));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(kVoxel * 1e3));
  auto accessor = grid->getAccessor();
  for (const Coord& center : centers) {
    for (int x = -half; x < half; ++x) {
      for (int y = -half; y < half; ++y) {
        for (int z = -half; z < half; ++z) {
          const Coord at = center.offsetBy(x, y, z);
          accessor.setValue(at, static_cast<float>(noise(at.x(), at.y(), at.z()) * kVoxel * 1e3));
        }
      }
    }
  }
  return makeLevelSet(grid, "mm");
}

/// The coefficient of one voxel as the formula in prefilter.h has it, term by term.
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

/// Cubic B-spline about 0 and its derivatives.
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

/// Value in voxels, derivatives by voxels; `orders` along the axes.
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

// Coefficients are floats of up to 6 voxels: 2.4e-7 each, added up with weights of up to 1, 3 and 8.
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

std::vector<InstructionSet> instructionSets() {
  std::vector<InstructionSet> sets{InstructionSet::kBase};
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (isSupported(set)) sets.push_back(set);
  }
  return sets;
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
  // A flat table of these 94 million blocks would have 375 MB.
  EXPECT_LT(field.bricks().memory(), 4'000'000U);
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vec3 half(9.0);
    expectIsSpline(field, (i % 2 == 0 ? Vec3(0.0) : far) + random.in({-half, half}));
  }
  // Between the two there is nothing, and it is outside.
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

/// Value, gradient and Hessian from both sides of faces, edges and corners of cells, leaves, and nodes
/// of 128 voxels: a billionth of a voxel apart, third derivatives of noise are below 100.
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
          // The same coefficients on either side, but for the rounding of sums.
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

/// A cell is known if its 64 coefficients are, and each of those if its voxel and its six neighbors are.
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

/// |value| and its sign against the true distance, at the rim of the band, beyond it and deep inside.
TEST(Bricks, OutOfTheBandTheyBoundTheDistance) {
  const std::vector<FieldPtr> shapes{sphere(Vec3(0.0), 12e-3), torus(10e-3, 4.5e-3),
                                     box(Vec3(0.0), Vec3(20e-3, 13e-3, 14e-3))};
  for (const FieldPtr& exact : shapes) {
    const FieldPtr grid = gridField(bake(*exact, voxels(kVoxel, 6.0)));
    // The spline without a prefilter, where the band ends, is off by voxel^2 / 6 of the second
    // derivatives, 2 / distance in all, and reaches 3.5 voxels.
    const double slack = kVoxel / 3.0 / 2.5;
    Random random(9);
    int in = 0, out = 0, deep = 0;
    for (int i = 0; i < 60000; ++i) {
      const Vec3 p = random.in(exact->bounds().grownBy((i % 10 + 1) * 1e-3));
      const double distance = exact->value(p);
      const FieldSample sample = grid->sample(p);
      if (std::abs(distance) > 0.3 * kVoxel) {
        ASSERT_EQ(std::signbit(sample.value), std::signbit(distance)) << distance;
      }
      // The farthest voxel that a sample needs is (3, 2, 2) off: 4.12.
      if (std::abs(distance) < 1.87 * kVoxel) {
        ASSERT_TRUE(sample.in_band) << distance;
      }
      if (std::abs(distance) > 6.0 * kVoxel) {
        ASSERT_FALSE(sample.in_band) << distance;
      }
      ++(sample.in_band ? in : out);
      if (sample.in_band) continue;
      ASSERT_EQ(sample.gradient, Vec3(0.0));
      ASSERT_LE(std::abs(sample.value), std::abs(distance) + slack);
      ASSERT_GE(std::abs(sample.value), 1.5 * kVoxel);
      deep += distance < -6.0 * kVoxel ? 1 : 0;
    }
    EXPECT_GT(in, 1000);
    EXPECT_GT(out, 1000);
    EXPECT_GT(deep, 100);
  }
}

TEST(Bricks, AllInstructionSetsAgree) {
  const LevelSet grid = noiseGrid({Coord(0)}, 14);
  for (const Sampler sampler : {Sampler::kCubic, Sampler::kTrilinear}) {
    const BrickField base(grid, sampler, InstructionSet::kBase);
    for (const InstructionSet set : instructionSets()) {
      const BrickField other(grid, sampler, set);
      Random random(7);
      for (int i = 0; i < 2000; ++i) {
        const Vec3 p = kVoxel * random.in({Vec3(-25.0), Vec3(25.0)});
        const FieldJet a = base.jet(p);
        const FieldJet b = other.jet(p);
        ASSERT_EQ(a.in_band, b.in_band);
        ASSERT_NEAR(a.value / kVoxel, b.value / kVoxel, 1e-12);  // sums of 64 doubles
        ASSERT_LE(glm::distance(a.gradient, b.gradient), 1e-12);
        ASSERT_NEAR(other.sample(p).value / kVoxel, b.value / kVoxel, 1e-13);
        if (sampler == Sampler::kTrilinear) continue;  // its Hessian is a difference of gradients
        for (int n = 0; n < 3; ++n) {
          ASSERT_LE(glm::distance(a.hessian[n], b.hessian[n]) * kVoxel, 1e-12);
        }
      }
    }
  }
}

TEST(Bricks, TheEnvironmentChoosesTheInstructionSet) {
  ASSERT_EQ(setenv("PALPATE_INSTRUCTION_SET", "base", 1), 0);
  EXPECT_EQ(chosenInstructionSet(), InstructionSet::kBase);
  ASSERT_EQ(setenv("PALPATE_INSTRUCTION_SET", "sse9", 1), 0);
  try {
    static_cast<void>(chosenInstructionSet());
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "bricks.instruction_set");
    EXPECT_NE(error.problem().message.find("sse9"), std::string::npos);
  }
  ASSERT_EQ(unsetenv("PALPATE_INSTRUCTION_SET"), 0);
  EXPECT_EQ(chosenInstructionSet(), instructionSets().back()) << "the best there is";
}

TEST(Bricks, NumbersOfAllSizesAreHarmless) {
  const FieldPtr field = gridField(bake(*sphere(Vec3(0.0), 10e-3), voxels(kVoxel)));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double x : {kNan, kInfinity, -kInfinity}) {
    for (int a = 0; a < 3; ++a) {
      Vec3 p(1e-3);
      p[a] = x;
      const FieldSample sample = field->sample(p);
      EXPECT_FALSE(std::isfinite(sample.value));
      EXPECT_FALSE(sample.in_band);
      EXPECT_EQ(sample.gradient, Vec3(0.0));
      EXPECT_FALSE(field->jet(p).in_band);
    }
  }
  for (const double x : {0.05, 1.0, 1e3, 1e9, 3e9, 1e18, 1e300}) {
    for (const double sign : {-1.0, 1.0}) {
      const FieldSample sample = field->sample(Vec3(0.0, sign * x, 0.0));
      EXPECT_FALSE(sample.in_band);
      EXPECT_LE(sample.value, x - 10e-3);
      EXPECT_GE(sample.value, (x - 18e-3) * (1.0 - 1e-12));
    }
  }
}

TEST(Bricks, TwoThreadsGetWhatOneGets) {
  const FieldPtr field = gridField(bake(*torus(10e-3, 4e-3), voxels(kVoxel)));
  std::vector<Vec3> points;
  Random random(8);
  for (int i = 0; i < 20000; ++i) points.push_back(random.in(field->bounds().grownBy(3e-3)));
  const auto run = [&](std::vector<double>& values) {
    for (const Vec3& p : points) values.push_back(field->sample(p).value + field->jet(p).value);
  };
  std::vector<double> alone;
  std::array<std::vector<double>, 2> together;
  run(alone);
  std::thread first([&] { run(together[0]); });
  std::thread second([&] { run(together[1]); });
  first.join();
  second.join();
  EXPECT_EQ(alone, together[0]);
  EXPECT_EQ(alone, together[1]);
}

}  // namespace
}  // namespace palpate::vdb
