// Grids as fields: the contract of all fields, convergence, and correct bounds outside the band.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "support/field_contract.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using palpate::test::FieldCase;
using palpate::test::FieldContract;
using palpate::test::Random;

FieldPtr baked(const FieldPtr& field, double voxel, double half_width = 4.0,
               Sampler sampler = Sampler::kAccessor) {
  return gridField(bake(*field, voxels(voxel, half_width)), sampler);
}

std::vector<FieldCase> contractCases() {
  std::vector<FieldCase> all;
  const auto add = [&](const std::string& name, const FieldPtr& field, double voxel, double band,
                       Sampler sampler) {
    FieldCase one;
    one.name = name;
    one.make = [=] { return baked(field, voxel, band, sampler); };
    one.region = field->bounds().grownBy(2e-3);
    all.push_back(one);
  };
  const FieldPtr holes =
      subtract({box(Vec3(0.0), Vec3(20e-3, 14e-3, 9e-3)), sphere(Vec3(0.0, 6e-3, 0.0), 5e-3)});
  for (const auto& [suffix, sampler] : {std::pair<std::string, Sampler>{"", Sampler::kAccessor},
                                        {"Trilinear", Sampler::kTrilinear},
                                        {"Cubic", Sampler::kCubic}}) {
    add("BakedBall" + suffix, sphere(Vec3(0.3e-3, -1e-3, 0.2e-3), 10e-3), 0.5e-3, 4.0, sampler);
    add("BakedBallNarrow" + suffix, sphere(Vec3(0.0), 10e-3), 0.7e-3, 2.0, sampler);
    add("BakedRing" + suffix, torus(10e-3, 4e-3), 0.5e-3, 6.0, sampler);
    add("BakedBrick" + suffix, box(Vec3(0.0), Vec3(10e-3, 14e-3, 9e-3)), 0.5e-3, 3.0, sampler);
    add("BakedHoles" + suffix, holes, 0.5e-3, 6.0, sampler);
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Grids, FieldContract, testing::ValuesIn(contractCases()),
                         testing::PrintToStringParamName());

struct Errors {
  double value_rms = 0.0, value_max = 0.0;    // [m]
  double normal_rms = 0.0, normal_max = 0.0;  // [degree]
};

/// Errors of a ball's grid, within one voxel of the surface.
Errors ballErrors(double radius, double voxel) {
  const FieldPtr exact = sphere(Vec3(0.1e-3, 0.2e-3, -0.15e-3), radius);
  const FieldPtr grid = baked(exact, voxel);
  Random random(42);
  Errors errors;
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 p =
        exact->bounds().center() + random.direction() * (radius + random.uniform(-voxel, voxel));
    const FieldSample found = grid->sample(p);
    const FieldSample wanted = exact->sample(p);
    EXPECT_TRUE(found.in_band);
    const double value = std::abs(found.value - wanted.value);
    const double sine = glm::length(glm::cross(glm::normalize(found.gradient), wanted.gradient));
    const double angle = std::asin(std::min(1.0, sine)) * 180.0 / std::numbers::pi;
    errors.value_rms += value * value / kPoints;
    errors.value_max = std::max(errors.value_max, value);
    errors.normal_rms += angle * angle / kPoints;
    errors.normal_max = std::max(errors.normal_max, angle);
  }
  errors.value_rms = std::sqrt(errors.value_rms);
  errors.normal_rms = std::sqrt(errors.normal_rms);
  return errors;
}

TEST(GridField, BallConvergesWithTheVoxelSize) {
  constexpr double kRadius = 15e-3;
  const std::vector<double> sizes{2e-3, 1e-3, 0.5e-3, 0.25e-3};
  std::vector<Errors> found;
  std::printf(
      "ball of radius 15 mm, 20000 points within a voxel of the surface\n"
      "voxel mm | value um RMS    max | normal degree RMS    max | order value  normal\n");
  for (const double voxel : sizes) {
    found.push_back(ballErrors(kRadius, voxel));
    const Errors& e = found.back();
    std::printf("%8.2f | %12.3f %6.2f | %17.3f %6.2f |", 1e3 * voxel, 1e6 * e.value_rms,
                1e6 * e.value_max, e.normal_rms, e.normal_max);
    if (found.size() == 1) {
      std::printf("\n");
      continue;
    }
    const Errors& before = found[found.size() - 2];
    const double value_order = std::log2(before.value_rms / e.value_rms);
    const double normal_order = std::log2(before.normal_rms / e.normal_rms);
    std::printf(" %11.2f %7.2f\n", value_order, normal_order);
    // Trilinear interpolation of exact distances has errors of voxel^2 for the value, and of voxel
    // for the gradient. The coarsest grid has 7 voxels per radius, where the next terms still
    // matter.
    EXPECT_NEAR(value_order, 2.0, 0.1);
    EXPECT_NEAR(normal_order, 1.0, 0.1);
  }
  // The leading term: |error| <= voxel^2 / 8 * (sum of second derivatives, 2 / r).
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double leading = sizes[i] * sizes[i] / 8.0 * 2.0 / (kRadius - 2.0 * sizes[i]);
    EXPECT_LT(found[i].value_max, leading);
  }
}

/// |value| outside the band, and its sign, compared with the true distance.
TEST(GridField, OutOfTheBandItIsABoundWithTheRightSign) {
  struct Shape {
    FieldPtr exact;
    double voxel, half_width;
  };
  const std::vector<Shape> shapes{{sphere(Vec3(0.0), 12e-3), 0.6e-3, 4.0},
                                  {sphere(Vec3(0.0), 12e-3), 0.6e-3, 2.0},
                                  {torus(10e-3, 4e-3), 0.5e-3, 3.0},
                                  {box(Vec3(0.0), Vec3(20e-3, 13e-3, 9e-3)), 0.5e-3, 3.0}};
  for (const Shape& shape : shapes) {
    const FieldPtr grid = baked(shape.exact, shape.voxel, shape.half_width);
    const double rim = shape.half_width * shape.voxel;
    // In cells at the rim of the band the interpolant must join the band, including its error of
    // voxel^2 / 8 times the sum of second derivatives, 2 / distance.
    const double slack = shape.voxel * shape.voxel / 4.0 / (rim - std::sqrt(3.0) * shape.voxel);
    Random random(5);
    int out = 0, deep = 0, far = 0;
    for (int i = 0; i < 60000; ++i) {
      const Vec3 p = random.in(shape.exact->bounds().grownBy((i % 10 + 1) * 2e-3));
      const double distance = shape.exact->value(p);
      const FieldSample sample = grid->sample(p);
      // Next to the surface the interpolant has an error of voxel^2 / 8 times the curvatures, or
      // that of an edge.
      if (std::abs(distance) > 0.3 * shape.voxel) {
        ASSERT_EQ(std::signbit(sample.value), std::signbit(distance)) << distance;
      }
      // A voxel that is nearer to the surface than the rim is active. All eight around p are
      // nearer than the rim if p is nearer by the cell's diagonal.
      if (std::abs(distance) < rim - std::sqrt(3.0) * shape.voxel) {
        ASSERT_TRUE(sample.in_band);
      }
      if (std::abs(distance) > rim + std::sqrt(3.0) * shape.voxel) {
        ASSERT_FALSE(sample.in_band);
      }
      if (sample.in_band) continue;
      ++out;
      ASSERT_EQ(sample.gradient, Vec3(0.0));
      ASSERT_LE(std::abs(sample.value), std::abs(distance) + slack);
      ASSERT_GE(std::abs(sample.value), rim - 2.0 * shape.voxel);
      if (std::abs(distance) < rim + shape.voxel) continue;
      // Away from the rim no tolerance is needed
      ASSERT_LE(std::abs(sample.value), std::abs(distance));
      deep += distance < 0.0 ? 1 : 0;
      far += distance > 0.0 ? 1 : 0;
    }
    EXPECT_GT(out, 1000);
    EXPECT_GT(deep + far, 1000);
    EXPECT_GT(far, 100);
  }
}

TEST(GridField, FarAwayTheBoundGrowsWithTheDistance) {
  const FieldPtr grid = baked(sphere(Vec3(0.0), 10e-3), 0.5e-3);
  for (const double x : {0.05, 1.0, 1e3, 1e9, 1e300}) {
    const FieldSample sample = grid->sample(Vec3(x, 0.0, 0.0));
    EXPECT_FALSE(sample.in_band);
    EXPECT_LE(sample.value, x - 10e-3);
    EXPECT_GE(sample.value, x - 13e-3);
  }
}

TEST(GridField, LipschitzBoundIsMeasuredAndTight) {
  // The slope of a distance is 1; within a cell of a curved surface, the steps along the axes
  // differ.
  EXPECT_NEAR(baked(sphere(Vec3(0.0), 12e-3), 0.5e-3)->lipschitz(), 1.0, 0.04);
  EXPECT_NEAR(baked(sphere(Vec3(0.0), 12e-3), 0.125e-3)->lipschitz(), 1.0, 0.01);
  // At a box's edge, two of the steps of one cell are 1; no field of distances exceeds sqrt(3).
  const double edges = baked(box(Vec3(0.0), Vec3(8.3e-3)), 0.5e-3)->lipschitz();
  EXPECT_GT(edges, 1.2);
  EXPECT_LE(edges, std::sqrt(3.0) + 1e-5);
}

}  // namespace
}  // namespace palpate::vdb
