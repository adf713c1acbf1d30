// Material grids compared with closed forms, and written to files and read back.

#include "palpate/vdb/material_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "palpate/vdb/io.h"
#include "support/alloc_guard.h"
#include "support/error_of.h"
#include "support/temp_file.h"
#include "vdb/python_oracle.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;

Image imageOf(const std::array<int, 3>& size, const std::function<double(const Vec3&)>& f) {
  Image image;
  image.source = "test";
  image.size = size;
  image.axes = Mat3(2e-3);
  image.origin = Vec3(-0.03, 0.01, -0.02);
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        image.values.push_back(static_cast<float>(f(image.toWorld(Vec3(i, j, k)))));
      }
    }
  }
  return image;
}

Image noise(const std::array<int, 3>& size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(200.0, 900.0);
  return imageOf(size, [&](const Vec3&) { return value(random); });
}

/// Rotated, sheared and left-handed, as scans may be.
Image oblique(Image image) {
  image.axes = Mat3(Vec3(1.1e-3, 0.4e-3, -0.2e-3), Vec3(-0.3e-3, -0.9e-3, 0.1e-3),
                    Vec3(0.2e-3, 0.3e-3, 2.1e-3));
  return image;
}

std::vector<Vec3> pointsAround(const MaterialGrid& grid, int count) {
  std::mt19937 random(7);
  const Box3& box = grid.info().bounds;
  const Vec3 margin = 0.3 * box.size();
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    Vec3 p;
    for (int a = 0; a < 3; ++a) {
      p[a] = std::uniform_real_distribution<double>(box.lo[a] - margin[a],
                                                    box.hi[a] + margin[a])(random);
    }
    points.push_back(p);
  }
  return points;
}

TEST(MaterialGrid, WhatIsLinearFromVoxelToVoxelIsMetExactly) {
  const Vec3 slope(2e4, -1e4, 5e3);
  const auto linear = [&](const Vec3& p) { return 900.0 + glm::dot(slope, p); };
  for (const bool turned : {false, true}) {
    Image image = imageOf({23, 17, 19}, linear);
    if (turned) {
      image = oblique(image);
      for (int k = 0, n = 0; k < 19; ++k) {
        for (int j = 0; j < 17; ++j) {
          for (int i = 0; i < 23; ++i) {
            image.values[static_cast<std::size_t>(n++)] =
                static_cast<float>(linear(image.toWorld(Vec3(i, j, k))));
          }
        }
      }
    }
    const MaterialGrid grid(image, 0.0);
    int inside = 0;
    for (const Vec3& p : pointsAround(grid, 4000)) {
      const Vec3 at = image.toIndex(p);
      const bool is_inner = glm::all(glm::greaterThan(at, Vec3(0.5))) &&
                            glm::all(glm::lessThan(at, Vec3(21.5, 15.5, 17.5)));
      if (!is_inner) continue;
      ++inside;
      const MaterialMap::Sample s = grid.sample(p);
      // Floats hold voxels of 900 to 6e-8 of that.
      ASSERT_NEAR(s.value, linear(p), 1e-4);
      ASSERT_LT(glm::length(s.gradient - slope), 1e-4 / 0.5e-3);
      ASSERT_EQ(s.value, grid.value(p));
    }
    EXPECT_GT(inside, 200);
  }
}

TEST(MaterialGrid, IsSmoothWithinItsRangeAndConstantBeyond) {
  for (const bool turned : {false, true}) {
    const Image image = turned ? oblique(noise({21, 9, 17}, 3)) : noise({21, 9, 17}, 3);
    const MaterialGrid grid(image, 0.0);
    const MaterialMap::Range range = grid.range();
    const double h = 1e-7;
    for (const Vec3& p : pointsAround(grid, 3000)) {
      const MaterialMap::Sample s = grid.sample(p);
      ASSERT_GE(s.value, range.least);
      ASSERT_LE(s.value, range.most);
      for (int a = 0; a < 3; ++a) {
        Vec3 d(0.0);
        d[a] = h;
        const double slope = (grid.value(p + d) - grid.value(p - d)) / (2.0 * h);
        // The second derivative of a spline through voxels that differ by up to 700: 1400 /
        // voxel^2.
        ASSERT_NEAR(slope, s.gradient[a], 1400.0 / (0.9e-3 * 0.9e-3) * h + 1.0);
      }
    }
    // Across every face between voxels, and between blocks of eight, value and gradient are
    // continuous.
    const Vec3 step = image.axes * Vec3(1e-9, 0, 0);
    for (int i = 0; i < 21; ++i) {
      const Vec3 p = image.toWorld(Vec3(i + 0.5, 3.3, 8.2));
      const MaterialMap::Sample a = grid.sample(p - step);
      const MaterialMap::Sample b = grid.sample(p + step);
      ASSERT_NEAR(a.value, b.value, 1e-5);
      ASSERT_LT(glm::length(a.gradient - b.gradient), 1e-2);
    }
    const Vec3 corner = image.toWorld(Vec3(20, 8, 16));
    const double edge = image.at(20, 8, 16);
    for (const double far : {0.5, 1.0, 1e3, 1e9, 1e300}) {
      const MaterialMap::Sample s = grid.sample(corner + image.axes * Vec3(far));
      EXPECT_EQ(s.value, edge) << far;
      EXPECT_LT(glm::length(s.gradient), 1e-9) << far;
    }
  }
}

TEST(MaterialGrid, ASmoothFunctionIsMetToTheSecondOrder) {
  // The spline's coefficients are the voxels, so that for a quadratic it is off by h^2 / 8 times
  // each second derivative.
  const auto f = [](const Vec3& p) { return 500.0 + 4e5 * p.x * p.x - 2e5 * p.y * p.y; };
  const Image image = imageOf({31, 31, 9}, f);
  const MaterialGrid grid(image, 0.0);
  for (const Vec3& index : {Vec3(10, 12, 4), Vec3(15.5, 20.25, 4.4), Vec3(8.1, 9.9, 5.5)}) {
    const Vec3 p = image.toWorld(index);
    EXPECT_NEAR(grid.value(p), f(p) + (8e5 - 4e5) * 2e-3 * 2e-3 / 8.0, 1e-3);
  }
}

TEST(MaterialGrid, FewerBitsKeepWithinTheTolerance) {
  const Image image = noise({33, 20, 11}, 5);
  const MaterialGrid exact(image, 0.0);
  EXPECT_EQ(exact.info().quantisation.bits, 32);
  EXPECT_EQ(exact.info().quantisation.error, 0.0);
  struct Row {
    double tolerance;
    int bits;
  };
  // A range of 700 N/m gives steps of 2.7 in 8 bits, and of 0.011 in 16 bits.
  for (const Row& row : {Row{2.0, 8}, Row{1.38, 8}, Row{1.3, 16}, Row{0.01, 16}, Row{0.005, 32}}) {
    const MaterialGrid grid(image, row.tolerance);
    const Quantisation& how = grid.info().quantisation;
    EXPECT_EQ(how.bits, row.bits) << row.tolerance;
    EXPECT_LE(how.error, row.tolerance);
    const double stated = how.error;
    double most = 0.0;
    const Image stored = grid.voxels();
    for (std::size_t i = 0; i < image.values.size(); ++i) {
      most = std::max(most, std::fabs(static_cast<double>(stored.values[i]) -
                                      static_cast<double>(image.values[i])));
    }
    EXPECT_NEAR(most, stated, 1e-4) << "what is stated is the largest error there is";
    for (const Vec3& p : pointsAround(grid, 3000)) {
      ASSERT_NEAR(grid.value(p), exact.value(p), stated + 1e-9);
      ASSERT_GE(grid.value(p), grid.range().least);
      ASSERT_LE(grid.value(p), grid.range().most);
    }
    EXPECT_LE(grid.info().memory,
              exact.info().memory * static_cast<unsigned>(row.bits) / 32 + 4096);
  }
}

TEST(MaterialGrid, OneValueIsThatValueBitForBit) {
  const MaterialGrid grid(imageOf({40, 30, 20}, [](const Vec3&) { return 0.3; }), 1e-3);
  for (const Vec3& p : pointsAround(grid, 500)) {
    ASSERT_EQ(grid.value(p), static_cast<double>(0.3F));
    ASSERT_EQ(grid.sample(p).gradient, Vec3(0.0));
  }
  EXPECT_LT(grid.info().memory, 10'000U) << "blocks of one value are not stored";
}

TEST(MaterialGrid, UnknownVoxelsTakeWhatIsAroundThem) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Image image = imageOf({12, 12, 12}, [&](const Vec3& p) { return p.x < 0.0 ? 300.0 : 700.0; });
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (i % 12 > 2) image.values[i] = nan;
  }
  const MaterialGrid grid(image, 0.0);
  EXPECT_EQ(grid.range().least, 300.0);
  EXPECT_EQ(grid.range().most, 300.0);
  for (float& value : image.values) value = nan;
  EXPECT_EQ(errorOf([&] { MaterialGrid none(image, 0.0); }).problem().code, "material.empty");
}

TEST(MaterialGrid, ReadingAllocatesNothing) {
  const MaterialGrid grid(noise({33, 20, 11}, 5), 0.02);
  const std::vector<Vec3> points = pointsAround(grid, 1000);
  const palpate::testing::AllocGuard guard;
  double sum = 0.0;
  for (const Vec3& p : points) sum += grid.value(p);
  EXPECT_EQ(guard.violations(), 0);
  EXPECT_GT(sum, 0.0);
}

TEST(MaterialGrid, TransferFunctionsAreLinearBetweenTheirPoints) {
  Image image = imageOf({5, 1, 1}, [](const Vec3&) { return 0.0; });
  image.values = {-1000.0F, -100.0F, 100.0F, 300.0F, 3000.0F};
  const Transfer transfer = {{-100.0, 200.0}, {300.0, 2000.0}};
  const Image out = materialFromImage(image, transfer, 0.0)->voxels();
  const std::vector<float> expected = {200.0F, 200.0F, 1100.0F, 2000.0F, 2000.0F};
  EXPECT_EQ(out.values, expected);
  EXPECT_EQ(errorOf([&] { (void)materialFromImage(image, {}, 0.0); }).problem().code,
            "material.transfer");
  EXPECT_EQ(errorOf([&] {
              (void)materialFromImage(image, {{1.0, 2.0}, {1.0, 3.0}}, 0.0);
            })
                .problem()
                .code,
            "material.transfer");
}

MaterialGridPtr thereAndBack(const MaterialGridPtr& grid, const std::string& path,
                             const std::string& length_unit) {
  const NamedMaterialGrid named = {
      "skin/stiffness", grid, "N/m", length_unit, {{"layer", "skin"}, {"source", "test"}}};
  writeVdb(path, {}, true, std::span(&named, 1));
  MaterialGridRequest request;
  request.name = "skin/stiffness";
  request.dimension = Dimension::kStiffness;
  return readMaterialGrid(path, request);
}

TEST(MaterialGridFile, ComesBackAsItWas) {
  const TempFolder folder;
  const std::string path = folder.path("grid.vdb");
  for (const bool turned : {false, true}) {
    for (const double tolerance : {0.0, 0.02, 2.0}) {
      for (const std::string unit : {"m", "mm"}) {
        SCOPED_TRACE(unit + " " + std::to_string(tolerance) + (turned ? " oblique" : ""));
        const Image image = turned ? oblique(noise({33, 20, 11}, 5)) : noise({33, 20, 11}, 5);
        const auto grid = std::make_shared<const MaterialGrid>(image, tolerance);
        const MaterialGridPtr back = thereAndBack(grid, path, unit);
        EXPECT_EQ(back->voxels().values, grid->voxels().values);
        EXPECT_EQ(back->info().quantisation.bits, grid->info().quantisation.bits);
        EXPECT_EQ(back->info().quantisation.step, grid->info().quantisation.step);
        EXPECT_EQ(back->info().quantisation.least, grid->info().quantisation.least);
        EXPECT_EQ(back->info().quantisation.error, grid->info().quantisation.error);
        EXPECT_EQ(back->range().least, grid->range().least);
        EXPECT_EQ(back->range().most, grid->range().most);
        for (const Vec3& p : pointsAround(*grid, 300)) {
          // In meters the place comes back to the last bit; another unit rounds it once.
          if (unit == "m") {
            ASSERT_EQ(back->value(p), grid->value(p));
          } else {
            ASSERT_NEAR(back->value(p), grid->value(p), 1e-9);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::vdb
