// Scans that are folded, porous and full of specks: their grids hold distances, and are certified.

#include <gtest/gtest.h>

#include <cmath>

#include "brick/bricks.h"
#include "grid/voxel_steps.h"
#include "palpate/vdb/scan_surface.h"
#include "vdb/certificate_judge.h"

namespace palpate::vdb {
namespace {

/// Folds about four voxels wide, with noise that makes holes and specks of one voxel, in a ball
/// that is dense in the middle.
Image folds(int seed) {
  constexpr int kSide = 48;
  palpate::test::Random random(seed);
  Image image;
  image.source = "folds";
  image.size = {kSide, kSide, kSide};
  image.axes = Mat3(1e-3);
  const Vec3 turn(random.uniform(0.0, 6.0), random.uniform(0.0, 6.0), random.uniform(0.0, 6.0));
  for (int k = 0; k < kSide; ++k) {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const Vec3 p = 0.8 * Vec3(i, j, k) + turn;
        const double fold = std::sin(p.x) * std::cos(p.y) + std::sin(p.y) * std::cos(p.z) +
                            std::sin(p.z) * std::cos(p.x);
        const double r = glm::length(Vec3(i, j, k) - 0.5 * (kSide - 1)) / (0.5 * kSide);
        const double value = fold + 2.0 - 3.5 * r * r * r + random.uniform(-1.0, 1.0);
        image.values.push_back(static_cast<float>(100.0 * value));
      }
    }
  }
  return image;
}

TEST(CertificateOfScans, BoundsHoldWhereThereAreHolesAndSpecksOfAVoxel) {
  for (int seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE(seed);
    for (const bool largest : {true, false}) {
      const LevelSet grid =
          surfaceFromThreshold(folds(seed), {.above = 100, .largest_component = largest}, {});
      test::expectBoundsHold(grid.info().name, grid, Sampler::kCubic, {Vec3(0.0), Vec3(0.047)});
    }
  }
}

// A regression: a speck between lattice points, found late, was taken over by its direct neighbors
// only. Voxels on the way then contradicted each other by more than two voxels, and points beside
// the surface did not answer.
TEST(CertificateOfScans, VoxelsAreDistancesOfOneSurface) {
  for (int seed = 0; seed < 3; ++seed) {
    const LevelSet grid = surfaceFromThreshold(folds(seed), {.above = 100}, {});
    const VoxelSteps steps = stepsOf(grid);
    std::printf(
        "voxels differ by up to %.2f voxels more than the way by the surface, %.2f away from it\n",
        steps.near.by, steps.far.by);
    // Away from the surface the differences come only from rounding of floats and from the choice
    // between two points. Beside it each of two voxels moves by up to 0.3 twice, so that the spline
    // passes through the surface, and the side may be that of the nearest lattice point.
    EXPECT_LE(steps.far.by, 0.6);
    EXPECT_LE(steps.near.by, 1.2);
  }
}

// Where the bound by slopes is not enough, the cells beside those that do not answer are examined;
// the bound from them must hold as well.
TEST(CertificateOfScans, TheLookAtCellsHoldsAsTheBoundBySlopesDoes) {
  for (int seed = 0; seed < 3; ++seed) {
    const LevelSet grid = surfaceFromThreshold(folds(seed), {.above = 100}, {});
    const double voxel = grid.info().voxel_size;
    const BandBounds by_slopes = surveyBricks(grid, Sampler::kCubic).bounds;
    const BandBounds by_cells = surveyBricks(grid, Sampler::kCubic, 2.0).bounds;
    std::printf("answers within %.2f voxels by slopes, %.2f by cells\n", by_slopes.within(),
                by_cells.within());
    EXPECT_EQ(by_slopes.least_way, 0.0);
    EXPECT_GT(by_cells.within(), by_slopes.within());
    const FieldPtr made = gridField(grid, Sampler::kCubic);
    palpate::test::Random random(seed);
    int near = 0;
    for (int i = 0; i < 200000; ++i) {
      const Vec3 p = random.in({Vec3(0.0), Vec3(0.047)});
      const FieldSample s = made->sample(p);
      if (!s.in_band || std::fabs(s.value) > 0.3 * voxel) continue;
      const Vec3 on = p - s.value / glm::dot(s.gradient, s.gradient) * s.gradient;
      if (std::fabs(made->sample(on).value) > 1e-3 * voxel) continue;
      ++near;
      ASSERT_TRUE(made->sample(on + 0.98 * voxel * by_cells.within() * random.direction()).in_band);
    }
    EXPECT_GT(near, 500);
  }
}

}  // namespace
}  // namespace palpate::vdb
