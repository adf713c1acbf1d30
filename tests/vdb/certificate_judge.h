#pragma once
// Checks a certificate against many samples of the grid: none may be outside its bounds.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "lib/render/hard_judge.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/register.h"

namespace palpate::vdb::test {

/// `grid` was made by palpate. `box`: region of the samples [m].
inline void expectBoundsHold(const std::string& name, const LevelSet& grid, Sampler sampler,
                             const Box3& box) {
  const double voxel = grid.info().voxel_size;
  CertifyOptions options;
  options.sampler = sampler;
  options.is_foreign = false;
  const BandCertificate sure = certified(grid, options).certificate;
  std::printf("%s, %s: answers within %.2f voxels, slopes %.2f to %.3f, %.1f %% rough\n",
              name.c_str(), sampler == Sampler::kCubic ? "cubic" : "trilinear", sure.within / voxel,
              sure.slope, sure.lipschitz, 100.0 * sure.rough);
  EXPECT_GE(sure.within, kLeastWithin * voxel);
  EXPECT_LE(sure.steepest, kMostSteep);
  const FieldPtr made = gridField(grid, sampler);
  palpate::test::Random random(7);
  int near = 0;
  for (int i = 0; i < 200000; ++i) {
    const Vec3 p = random.in(box);
    const FieldSample s = made->sample(p);
    // A step along the gradient leads to the surface if that is near; from there, all points within
    // w must answer.
    if (s.in_band && std::fabs(s.value) < 0.3 * voxel) {
      const Vec3 on = p - s.value / glm::dot(s.gradient, s.gradient) * s.gradient;
      if (std::fabs(made->sample(on).value) > 1e-3 * voxel) continue;
      ++near;
      ASSERT_TRUE(made->sample(on + 0.99 * sure.within * random.direction()).in_band);
    }
    if (!s.in_band) continue;
    ASSERT_LE(glm::length(s.gradient), sure.lipschitz);
    if (std::fabs(s.value) < 1.5 * voxel) {
      ASSERT_LE(glm::length(s.gradient), sure.steepest + 1e-3);
    }
    if (std::fabs(s.value) < 0.01 * voxel) {
      ASSERT_GE(glm::length(s.gradient), sure.slope - 1e-3);
    }
  }
  EXPECT_GT(near, 500);
}

}  // namespace palpate::vdb::test
