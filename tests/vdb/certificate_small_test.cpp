// Shapes as small as a few voxels: refused, reported, or as exact as the certificate says.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/certificate.h"
#include "support/error_of.h"
#include "support/field_contract.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using test::voxels;

constexpr double kVoxel = 1e-3;

CertifyOptions own() {
  CertifyOptions options;
  options.is_foreign = false;
  return options;
}

/// [voxels] The largest error of the sampled surface of a ball's grid, over many directions;
/// infinite if a ray outwards meets no surface.
double worstOf(const LevelSet& grid, const Vec3& center, double radius) {
  const FieldPtr made = gridField(grid, Sampler::kCubic);
  palpate::test::Random random(5);
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 out = random.direction();
    const FieldSample s = made->sample(center + radius * out);
    const double slope = glm::length(s.gradient);
    if (!s.in_band || !(slope > 0.0)) return kInfinity;
    worst = std::max(worst, std::fabs(s.value) / slope);
  }
  return worst / kVoxel;
}

TEST(CertificateOfSmall, ABallOfAnySizeIsRefusedNotedOrAsExactAsStated) {
  palpate::test::Random random(11);
  int refused = 0;
  int noted = 0;
  int held = 0;
  int smooth = 0;
  for (int i = 0; i < 300; ++i) {
    const double radius = kVoxel * random.uniform(0.05, 4.0);
    const Vec3 center = kVoxel * Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
                                      random.uniform(-0.5, 0.5));
    SCOPED_TRACE("radius " + std::to_string(radius / kVoxel) + " voxels");
    try {
      const LevelSet grid = bake(*sphere(center, radius), voxels(kVoxel, kCubicHalfWidth));
      const CertifiedGrid sure = certified(grid, own());
      const double worst = worstOf(sure.grid, center, radius);
      if (!roughNote(sure.grid, sure.certificate).empty()) {
        ++noted;
        EXPECT_LT(radius, 2.0 * kVoxel) << "a ball of two voxels has no rough cell";
        continue;
      }
      ++held;
      // `off` holds where the surface is smooth, and `rough` tells that not all of it is.
      if (sure.certificate.rough == 0.0) {
        ++smooth;
        EXPECT_LE(worst, sure.certificate.off / kVoxel);
      }
    } catch (const Error& error) {
      ++refused;
      EXPECT_TRUE(error.problem().code == "vdb.no_surface" ||
                  error.problem().code == "bake.empty" || error.problem().code == "bake.too_thin")
          << error.what();
      EXPECT_FALSE(error.problem().hint.empty());
      EXPECT_LT(radius, 1.0 * kVoxel);
    }
  }
  std::printf("balls of 0.05 to 4 voxels: %d refused, %d noted, %d held, %d of them all smooth\n",
              refused, noted, held, smooth);
  EXPECT_GT(refused, 5);
  EXPECT_GT(noted, 5);
  EXPECT_GT(smooth, 100);
}

TEST(CertificateOfSmall, SamplesThatNeverReachTheSurfaceAreNamed) {
  // One voxel is inside; samples between the voxels are not.
  const LevelSet grid = bake(*sphere(Vec3(0.0), 0.06 * kVoxel), voxels(kVoxel, kCubicHalfWidth));
  const Error error = errorOf([&] { (void)certified(grid, own()); });
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.problem().code, "vdb.no_surface");
  EXPECT_NE(error.problem().message.find("1 mm"), std::string::npos) << error.what();
}

TEST(CertificateOfSmall, WhatIsHardlySmoothAnywhereIsToldWithAPlace) {
  const LevelSet grid = bake(*sphere(Vec3(0.0), 0.5 * kVoxel), voxels(kVoxel, kCubicHalfWidth));
  const CertifiedGrid sure = certified(grid, own());
  EXPECT_GT(sure.certificate.rough, kMostRough);
  const std::string note = roughNote(sure.grid, sure.certificate);
  EXPECT_NE(note.find("smaller voxels"), std::string::npos) << note;
  EXPECT_NE(note.find(") mm"), std::string::npos) << note;
  EXPECT_EQ(sure.notes.size(), 0U) << "nothing was done to it";
}

}  // namespace
}  // namespace palpate::vdb
