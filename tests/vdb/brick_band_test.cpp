// Values of bricks outside their band, bounds of their slopes, and numbers of all sizes.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"
#include "vdb/noise_grid.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using openvdb::Coord;
using palpate::test::Random;

constexpr double kVoxel = 0.5e-3;  // [m]

/// |value| and its sign compared with the true distance: at the rim of the band, beyond it and deep
/// inside.
TEST(Bricks, OutOfTheBandTheyBoundTheDistance) {
  const std::vector<FieldPtr> shapes{sphere(Vec3(0.0), 12e-3), torus(10e-3, 4.5e-3),
                                     box(Vec3(0.0), Vec3(20e-3, 13e-3, 14e-3))};
  for (const FieldPtr& exact : shapes) {
    const FieldPtr grid = gridField(bake(*exact, voxels(kVoxel, 6.0)));
    // Where the band ends, the spline has no prefilter: its error is voxel^2 / 6 times the sum of
    // second derivatives, 2 / distance, and it reaches 3.5 voxels.
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

/// The steepest slope between many pairs of points, near and far.
double steepestWay(const Field& field, const Box3& box, int seed) {
  Random random(static_cast<std::uint64_t>(seed));
  double most = 0.0;
  for (int i = 0; i < 60000; ++i) {
    const Vec3 p = random.in(box);
    const Vec3 q =
        i % 3 == 0 ? random.in(box) : p + (i % 3 == 1 ? 1.0 : 1e-3) * kVoxel * random.direction();
    const double way = glm::distance(p, q);
    if (way > 0.0) most = std::max(most, std::fabs(field.value(p) - field.value(q)) / way);
    // The gradient is the steepest slope at a point.
    most = std::max(most, glm::length(field.sample(p).gradient));
  }
  return most;
}

TEST(Bricks, NoWayIsSteeperThanTheLipschitzBound) {
  struct Case {
    const char* name;
    LevelSet grid;
    Box3 box;
    double loose;  // how many times the largest slope found the bound may be
  };
  const auto of = [](const char* name, const FieldPtr& field, double loose) {
    return Case{name, bake(*field, voxels(kVoxel)), field->bounds().grownBy(4e-3), loose};
  };
  const Vec3 half(12.0 * kNoiseVoxel);
  const std::vector<Case> cases{of("ball of 24 voxels", sphere(Vec3(0.1e-3), 12e-3), 1.05),
                                of("ball of 100 voxels", sphere(Vec3(0.1e-3), 50e-3), 1.02),
                                of("torus, tube of 8 voxels", torus(12e-3, 4e-3), 1.15),
                                of("box", box(Vec3(0.0), Vec3(12e-3, 9.3e-3, 8.1e-3)), 2.5),
                                // Noise is nowhere as steep as its coefficients would allow.
                                {"noise", noiseGrid({Coord(0)}, 14), {-half, half}, 20.0}};
  for (const Case& each : cases) {
    for (const Sampler sampler : {Sampler::kCubic, Sampler::kTrilinear, Sampler::kAccessor}) {
      SCOPED_TRACE(::testing::Message() << each.name << ", sampler " << static_cast<int>(sampler));
      const FieldPtr field = gridField(each.grid, sampler);
      const double found = steepestWay(*field, each.box, 5);
      EXPECT_LE(found, field->lipschitz() * (1.0 + 1e-9));
      EXPECT_LE(field->lipschitz(), each.loose * std::max(1.0, found));
      std::printf("%s, sampler %d: bound %.4f, found %.4f\n", each.name, static_cast<int>(sampler),
                  field->lipschitz(), found);
    }
  }
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

}  // namespace
}  // namespace palpate::vdb
