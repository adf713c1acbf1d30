// Scans that Debian packages carry, as they are read: against nibabel, ITK, and the program that made one of them.
#include "vdb/debian_scans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "itk/itk_image.h"
#include "palpate/vdb/image.h"
#include "vdb/python_oracle.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;

// Both sides compute in double from the file's numbers: far below 1e-5 mm.
constexpr double kMm = 1e-5;

std::map<double, std::size_t> histogramOf(const Image& image) {
  std::map<double, std::size_t> counts;
  for (const float value : image.values) ++counts[static_cast<double>(value)];
  return counts;
}

/// How far a corner of an image is at most from where rows of 3 x 4 numbers have it [mm].
template <typename Twelve>
double farthestOff(const Image& image, const Twelve& affine) {
  double worst = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index(0.0);
    for (int a = 0; a < 3; ++a) {
      index[a] = (corner >> a & 1) * (image.size[static_cast<std::size_t>(a)] - 1);
    }
    const Vec3 ours = image.toWorld(index) * 1e3;
    for (std::size_t row = 0; row < 3; ++row) {
      const double theirs = affine[4 * row] * index.x + affine[4 * row + 1] * index.y +
                            affine[4 * row + 2] * index.z + affine[4 * row + 3];
      worst = std::max(worst, std::abs(ours[static_cast<int>(row)] - theirs));
    }
  }
  return worst;
}

// Bytes and floats, from the left to the right and the other way round. nibabel takes the sform where both are set.
TEST(DebianScans, TemplatesAreAsNibabelHasThem) {
  const std::vector<std::string> files = {test::mricron("AICHAmc.nii.gz"),
                                          test::mricron("inia19-t1-brain.nii.gz")};
  ImageOptions options;
  options.affine = AffineChoice::kSform;
  const auto affines = test::askPython("affine", files);
  const auto histograms = test::askPython("histogram", files);
  for (std::size_t n = 0; n < files.size(); ++n) {
    SCOPED_TRACE(files[n]);
    const Image image = readImage(files[n], options);
    EXPECT_LT(farthestOff(image, affines.at(n)), kMm);
    std::map<double, std::size_t> expected;
    for (std::size_t i = 0; i + 1 < histograms.at(n).size(); i += 2) {
      expected[histograms[n][i]] = static_cast<std::size_t>(histograms[n][i + 1]);
    }
    EXPECT_EQ(histogramOf(image), expected);
  }
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
  EXPECT_LT(farthestOff(image, itk.affine), kMm);
  EXPECT_EQ(histogramOf(image), itk.histogram);
  EXPECT_EQ(image.at(108, 60, 7), static_cast<float>(ct.values[ct.index(128, 60, 47)]));
  EXPECT_NEAR(glm::length(image.axes[2]), 1.5e-3, 1e-12);
}

// InVesalius kept which voxels it took for bone: those are the ones above the threshold, and no other.
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
