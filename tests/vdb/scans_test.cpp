// Every real scan compared with nibabel, ITK and pydicom: the places of its voxels, and their
// values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include "itk/itk_image.h"
#include "palpate/vdb/image.h"
#include "support/scan_folder.h"
#include "vdb/image_checks.h"

namespace palpate::vdb {
namespace {

const std::string kData = palpate::testing::scansFolder();

std::vector<std::string> scansBelow(const std::string& folder, const std::string& extension) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().string().ends_with(extension)) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Scans, NiftiIsAsNibabelHasIt) {
  PALPATE_NEEDS_SCAN(kData);
  const auto files = scansBelow(kData, ".nii.gz");
  ASSERT_GE(files.size(), 7U);
  test::expectAsNibabelHas(files);
}

TEST(Scans, NrrdAndMetaImageAreAsItkHasThem) {
  PALPATE_NEEDS_SCAN(kData);
  std::vector<std::string> files = scansBelow(kData, ".nrrd");
  const auto meta = scansBelow(kData, ".mhd");
  files.insert(files.end(), meta.begin(), meta.end());
  ASSERT_GE(files.size(), 8U);
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    // ITK reads it as two numbers per voxel; see below
    if (file.ends_with("Overlapping.seg.nrrd")) continue;
    const bool without_place = file.ends_with("hand_lowres.nrrd");
    ImageOptions options;
    if (without_place) options.affine = AffineChoice::kSpacing;
    const Image image = readImage(file, options);
    const test::ItkImage itk = test::readWithItk(file);
    EXPECT_EQ(image.size, itk.size);
    EXPECT_EQ(test::histogramOf(image), itk.histogram);
    // For an image without a place ITK assumes L, P, S, so that LPS is requested here.
    if (!without_place) {
      EXPECT_LT(test::farthestOff(image, itk.affine), test::kSamePlace);
    }
  }
}

TEST(Scans, DicomIsAsItkHasIt) {
  for (const std::string folder : {"/dicom_cthead", "/abdomen_dicom/series"}) {
    SCOPED_TRACE(folder);
    PALPATE_NEEDS_SCAN(kData + folder);
    const Image image = readImage(kData + folder);
    const test::ItkImage itk = test::readSeriesWithItk(kData + folder);
    EXPECT_EQ(image.size, itk.size);
    EXPECT_LT(test::farthestOff(image, itk.affine), test::kSamePlace);
    EXPECT_EQ(test::histogramOf(image), itk.histogram);
  }
}

TEST(Scans, LabelsOfADicomSeriesLieOnItsRibs) {
  const std::string folder = kData + "/abdomen_dicom";
  PALPATE_NEEDS_SCAN(folder);
  const Image ct = readImage(folder + "/series");
  const Image labels = readImage(folder + "/seg_LAS.nii.gz");
  double sum = 0.0;
  std::size_t count = 0;
  for (int k = 0; k < labels.size[2]; ++k) {
    for (int j = 0; j < labels.size[1]; ++j) {
      for (int i = 0; i < labels.size[0]; ++i) {
        const float label = labels.at(i, j, k);
        if (!(label >= 92.0F && label <= 115.0F)) continue;  // ribs
        const Vec3 there = glm::round(ct.toIndex(labels.toWorld({i, j, k})));
        sum += static_cast<double>(
            ct.at(static_cast<int>(there.x), static_cast<int>(there.y), static_cast<int>(there.z)));
        ++count;
      }
    }
  }
  const double mean = sum / static_cast<double>(count);
  const auto expected =
      test::askPython("mean", {folder + "/series", folder + "/seg_LAS.nii.gz", "92", "115"});
  EXPECT_EQ(static_cast<double>(count), expected.at(0).at(1));
  // Sums of the same integers: the difference is rounding.
  EXPECT_NEAR(mean, expected[0][0], 1e-6);
  EXPECT_NEAR(mean, 275.0, 5.0);
  std::printf("mean of the ribs: %.2f HU (%zu voxels)\n", mean, count);
}

TEST(Scans, TheTwoFilesOfAPairAreOneGeometry) {
  const std::string folder = kData + "/orientation_pair/";
  PALPATE_NEEDS_SCAN(folder);
  const Image a = readImage(folder + "FLAIR.nii.gz");
  const Image b = readImage(folder + "FLAIR.nrrd");
  EXPECT_EQ(a.size, b.size);
  EXPECT_EQ(a.values, b.values);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index((corner & 1) * (a.size[0] - 1), (corner >> 1 & 1) * (a.size[1] - 1),
                     (corner >> 2 & 1) * (a.size[2] - 1));
    // The NIfTI's numbers are single precision: 200 mm to 24 bits.
    EXPECT_LT(glm::length(a.toWorld(index) - b.toWorld(index)) * 1e3, 1e-4);
  }
}

TEST(Scans, OverlappingSegmentsShareVoxelsByTheRule) {
  const std::string folder = kData + "/chest_segnrrd/";
  PALPATE_NEEDS_SCAN(folder);
  const Image plain = readImage(folder + "Segmentation.seg.nrrd");
  const Image image = readImage(folder + "SegmentationOverlapping.seg.nrrd");
  // The two layers, each read by itself.
  ImageOptions first, second;
  first.frame = 0;
  second.frame = 1;
  const Image below = readImage(folder + "SegmentationOverlapping.seg.nrrd", first);
  const Image above = readImage(folder + "SegmentationOverlapping.seg.nrrd", second);
  EXPECT_EQ(below.values, plain.values);
  std::size_t shared = 0;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (above.values[i] != 0.0F && below.values[i] != 0.0F) ++shared;
    // Label 1 of layer 1 is the eighth segment; as the later one in the file it gets the voxel.
    ASSERT_EQ(image.values[i], above.values[i] != 0.0F ? 8.0F : below.values[i]);
  }
  EXPECT_EQ(shared, 15514U);
  ASSERT_EQ(image.labels.names.size(), 8U);
  EXPECT_EQ(image.labels.names.at(1), "ribs");
  EXPECT_EQ(image.labels.names.at(8), "overlapping sphere");
  EXPECT_EQ(image.labels.colors.at(2), (LabelColor{1.0F, 1.0F, 0.811765F}));
  ASSERT_EQ(image.notes.size(), 2U);
  EXPECT_NE(image.notes[0].find("it is label 8 here"), std::string::npos);
  EXPECT_EQ(image.notes[1].find("15514 voxels (1.44e+03 cm^3) are in several segments"), 0U);
}

TEST(Scans, NamesInsideTotalSegmentatorsFileAreThoseOfItsTable) {
  const std::string folder = kData + "/abdomen/";
  PALPATE_NEEDS_SCAN(folder);
  const ImageInfo info = readImageInfo(folder + "example_seg.nii.gz");
  EXPECT_TRUE(info.is_labels);
  NameTable table = readLabelTable(folder + "labels.csv").names;
  table.erase(0);
  EXPECT_EQ(info.labels.names, table);
  EXPECT_EQ(info.labels.colors.at(1), (LabelColor{0.0F, 1.0F, 0.0F}));
  // The image also serves as a table.
  EXPECT_EQ(readLabelTable(folder + "example_seg.nii.gz").names, table);
}

}  // namespace
}  // namespace palpate::vdb
