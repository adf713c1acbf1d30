// Level sets as images, and images as NIfTI files that our reader and nibabel read back.

#include "palpate/vdb/grid_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "support/error_of.h"
#include "support/temp_file.h"

namespace palpate::vdb {
namespace {

using ::palpate::testing::TempFolder;

LevelSet ball() {
  BakeOptions options;
  options.voxel_size = 0.001;
  options.half_width = 3.0;
  return bake(*sphere(Vec3(0.0115, -0.0202, 0.0303), 0.008), options);
}

TEST(GridImage, HoldsTheDistanceWhereItIs) {
  const LevelSet grid = ball();
  const Image image = gridImage(grid);
  ASSERT_EQ(image.values.size(),
            static_cast<std::size_t>(image.size[0]) * image.size[1] * image.size[2]);
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i) {
        const Vec3 at = image.toWorld(Vec3(i, j, k));
        const double distance = 1e3 * (glm::length(at - Vec3(0.0115, -0.0202, 0.0303)) - 0.008);
        // The distance is in mm, as a float; beyond the band it is the band's width.
        ASSERT_NEAR(image.at(i, j, k), std::clamp(distance, -3.0, 3.0), 1e-5) << i << j << k;
      }
    }
  }
}

Image ramp() {
  Image image;
  image.source = "ramp";
  image.size = {7, 5, 3};
  // Oblique, sheared and left-handed.
  image.axes = Mat3(Vec3(-1e-3, 2e-4, 0.0), Vec3(3e-4, 2e-3, 1e-4), Vec3(0.0, -5e-4, 3e-3));
  image.origin = Vec3(0.1234, -0.05678, 0.9);
  for (int i = 0; i < 7 * 5 * 3; ++i) image.values.push_back(0.37F * static_cast<float>(i) - 11.0F);
  return image;
}

TEST(EncodeNifti, ReadsBackPlainAndCompressed) {
  const TempFolder folder;
  const Image image = ramp();
  for (const bool gzip : {false, true}) {
    const Image back =
        readNifti(folder.file(gzip ? "ramp.nii.gz" : "ramp.nii", encodeNifti(image, gzip)));
    EXPECT_EQ(back.size, image.size);
    EXPECT_EQ(back.values, image.values);
    EXPECT_TRUE(back.notes.empty());
    // The place is stored as floats in mm: 900 mm to 3e-5 mm.
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(glm::length(back.axes[axis] - image.axes[axis]), 1e-9);
    }
    EXPECT_LE(glm::length(back.origin - image.origin), 1e-7);
  }
}

TEST(EncodeNifti, RefusesWhatTheFormatCannotHold) {
  Image image = ramp();
  image.size[1] = 40000;
  EXPECT_EQ(errorOf([&] { (void)encodeNifti(image, false); }).problem().code, "nifti.size");
  image = ramp();
  image.values.pop_back();
  EXPECT_EQ(errorOf([&] { (void)encodeNifti(image, true); }).problem().code, "nifti.size");
}

}  // namespace
}  // namespace palpate::vdb
