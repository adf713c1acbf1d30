// Scans from Debian packages, as palpate reads them, compared with nibabel, ITK, and the program
// that made one of them.
#include "vdb/debian_scans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "itk/itk_image.h"
#include "palpate/vdb/image.h"
#include "vdb/image_checks.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;

// Bytes and floats, with x running either way. nibabel takes the sform if both forms are set.
TEST(DebianScans, TemplatesAreAsNibabelHasThem) {
  const std::vector<std::string> files = {test::mricron("AICHAmc.nii.gz"),
                                          test::mricron("inia19-t1-brain.nii.gz")};
  ImageOptions options;
  options.affine = AffineChoice::kSform;
  test::expectAsNibabelHas(files, options);
}

TEST(HeadCt, IsAsItkHasIt) {
  const test::HeadCt ct = test::readHeadCt();
  EXPECT_EQ(ct.size, (std::array{256, 256, 108}));
  const TempFolder folder;
  const std::string file = test::writePart(ct, {20, 0, 40}, {219, 255, 69}, folder);
  const Image image = readImage(file);
  const test::ItkImage itk = test::readWithItk(file);
  EXPECT_EQ(image.size, (std::array{200, 256, 30}));
  EXPECT_EQ(image.size, itk.size);
  EXPECT_LT(test::farthestOff(image, itk.affine), test::kSamePlace);
  EXPECT_EQ(test::histogramOf(image), itk.histogram);
  EXPECT_EQ(image.at(108, 60, 7), static_cast<float>(ct.values[ct.index(128, 60, 47)]));
  EXPECT_NEAR(glm::length(image.axes[2]), 1.5e-3, 1e-12);
}

// InVesalius stored the voxels that it found to be bone: exactly those above the threshold.
TEST(HeadCt, BoneIsWhatInVesaliusTookForIt) {
  const test::HeadCt ct = test::readHeadCt();
  const TempFolder folder;
  const Image image = readImage(test::writePart(ct, {0, 0, 0}, {255, 255, 107}, folder));
  ASSERT_EQ(image.values.size(), ct.mask.size());
  EXPECT_EQ(ct.lowest, 226.0);
  std::size_t bone = 0;
  std::size_t differ = 0;
  for (std::size_t n = 0; n < ct.mask.size(); ++n) {
    const bool is_bone = static_cast<double>(image.values[n]) >= ct.lowest;
    bone += is_bone ? 1U : 0U;
    differ += is_bone != (ct.mask[n] != 0) ? 1U : 0U;
  }
  EXPECT_EQ(differ, 0U);
  EXPECT_EQ(bone, 475'759U);
}

}  // namespace
}  // namespace palpate::vdb
