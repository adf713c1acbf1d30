// DICOM segmentations and structure sets written by pydicom, compared with pydicom and numpy;
// damaged ones are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"
#include "support/error_of.h"
#include "support/temp_file.h"
#include "vdb/dicom_writer.h"
#include "vdb/nifti_writer.h"
#include "vdb/structure_points.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;
using test::askScript;
using test::kStructuresOracle;

/// Writes a label volume on an oblique, orthogonal grid, which DICOM can hold; returns its path.
std::string writeVolume(const TempFolder& folder, unsigned seed) {
  std::mt19937 random(seed);
  test::NiftiFile file;
  // 77 pixels in a plane: planes of bits do not begin at a byte.
  file.dim = {11, 7, 9};
  file.datatype = 4;
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  file.sform = {{{-1.5 * c, 0.75 * s, 0, 20}, {-1.5 * s, -0.75 * c, 0, -7}, {0, 0, 2.5, 40}}};
  while (file.values.size() < 693) {
    // Labels with gaps between their numbers; the first and the last plane contain none.
    const int label = static_cast<int>(random() % 4);
    const std::size_t plane = file.values.size() / 77;
    for (auto n = 1 + random() % 9; n > 0 && file.values.size() < 693; --n) {
      file.values.push_back(plane == 0 || plane == 8 ? 0 : label == 3 ? 300 : label);
    }
  }
  const test::Bytes bytes = test::bytesOf(file);
  return folder.file("labels.nii",
                     std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

class SegmentationKinds : public ::testing::TestWithParam<const char*> {};

TEST_P(SegmentationKinds, AreTheLabelVolumeThatTheyWereMadeOf) {
  const std::string kind = GetParam();
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const TempFolder folder;
    const Image volume = readImage(writeVolume(folder, seed));
    const std::string file = folder.path("seg.dcm");
    (void)askScript(kStructuresOracle, "write_seg", {volume.source, kind, file});
    const Image image = readImage(file);
    // Every voxel of the volume has a voxel of the segmentation at its place; planes around it are
    // empty.
    std::size_t labelled = 0;
    for (int k = 0; k < volume.size[2]; ++k) {
      for (int j = 0; j < volume.size[1]; ++j) {
        for (int i = 0; i < volume.size[0]; ++i) {
          const float label = volume.at(i, j, k);
          const Vec3 index = image.toIndex(volume.toWorld(Vec3(i, j, k)));
          const Vec3 at = glm::round(index);
          ASSERT_LT(glm::length(index - at), 1e-4);
          if (at.z < 0 || at.z >= image.size[2]) {
            ASSERT_EQ(label, 0.0F);
            continue;
          }
          ASSERT_EQ(
              image.at(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)),
              label);
          labelled += label > 0.0F ? 1 : 0;
        }
      }
    }
    EXPECT_EQ(static_cast<std::size_t>(std::count_if(image.values.begin(), image.values.end(),
                                                     [](float v) { return v > 0.0F; })),
              labelled);
    test::expectLabelsAt(image, askScript(kStructuresOracle, "seg", {file, "1000", "3"}), 1000);
    EXPECT_EQ(image.labels.names, (NameTable{{1, "part 1"}, {2, "part 2"}, {300, "part 300"}}));
    // Red of sRGB in CIE L*a*b*, in 16 bits.
    const LabelColor color = image.labels.colors.at(300);
    EXPECT_NEAR(color[0], 1.0F, 0.01F);
    EXPECT_NEAR(color[1], 0.0F, 0.02F);
    EXPECT_NEAR(color[2], 0.0F, 0.02F);
    const LabelCodes codes = readLabelCodes(file);
    ASSERT_EQ(codes.size(), 3U);
    EXPECT_EQ(codes.at(2).value, "10200004");
    EXPECT_EQ(codes.at(2).scheme, "SCT");
    const ImageInfo info = readImageInfo(file);
    EXPECT_EQ(info.format, "DICOM segmentation");
    EXPECT_EQ(info.size, image.size);
    EXPECT_EQ(info.labels.names, image.labels.names);
    EXPECT_TRUE(info.is_labels);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SegmentationKinds,
                         ::testing::Values("binary", "implicit", "fractional", "labelmap",
                                           "packed"));

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// `text` with its only occurrence of `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(DicomSegmentation, BesideItsSeriesIsReadByItsOwnName) {
  const TempFolder folder;
  const std::string series =
      test::writeSeries(folder, "s", 4, {0, 0, 2}, [](test::DicomFile&, int) {});
  const std::string volume = writeVolume(folder, 1);
  (void)askScript(kStructuresOracle, "write_seg", {volume, "binary", series + "/a_seg.dcm"});
  const Image slices = readImage(series);
  EXPECT_EQ(slices.size[2], 4);
  EXPECT_TRUE(std::any_of(slices.notes.begin(), slices.notes.end(), [](const std::string& note) {
    return note.find("1 DICOM segmentations were ignored") != std::string::npos;
  }));
  EXPECT_EQ(readImage(series + "/a_seg.dcm").labels.names.size(), 3U);
  // A folder may stand for the only file in it; if there are two, one has to be named.
  std::filesystem::create_directory(folder.path("alone"));
  (void)folder.file("alone/seg", textOf(series + "/a_seg.dcm"));
  EXPECT_EQ(readImage(folder.path("alone")).labels.names.size(), 3U);
  (void)folder.file("alone/other", textOf(series + "/a_seg.dcm"));
  EXPECT_EQ(errorOf([&] { (void)readImage(folder.path("alone")); }).problem().code,
            "dicom.several");
}

TEST(DicomSegmentation, DamageIsRefusedByNameAndNeverTakenForWhole) {
  const TempFolder folder;
  const std::string file = folder.path("seg.dcm");
  (void)askScript(kStructuresOracle, "write_seg", {writeVolume(folder, 2), "binary", file});
  const std::string whole = textOf(file);
  // Truncated at many places, in steps coprime to the even lengths in the file.
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const std::string cut = folder.file("cut.dcm", std::string_view(whole).substr(0, length));
    const Error error = errorOf([&] { (void)readImage(cut); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput) << length;
    EXPECT_EQ(error.problem().file, cut) << length;
  }
  const auto code_of = [&](const std::string& text) {
    return errorOf([&] { (void)readImage(folder.file("bad.dcm", text)); }).problem().code;
  };
  EXPECT_EQ(code_of(with(whole, "BINARY", "BRAINS")), "dicom.segments");
  const auto bytes = [](std::initializer_list<int> values) {
    std::string out;
    for (const int value : values) out += static_cast<char>(value);
    return out;
  };
  // Segment number 2 of the table becomes 1: two segments with one number.
  EXPECT_EQ(code_of(with(whole, bytes({0x62, 0, 4, 0, 'U', 'S', 2, 0, 2, 0}),
                         bytes({0x62, 0, 4, 0, 'U', 'S', 2, 0, 1, 0}))),
            "dicom.segments");
  // The first frame now refers to segment 7, which does not exist.
  EXPECT_EQ(code_of(with(whole, bytes({0x62, 0, 11, 0, 'U', 'S', 2, 0, 1, 0}),
                         bytes({0x62, 0, 11, 0, 'U', 'S', 2, 0, 7, 0}))),
            "dicom.segments");
  // One row more than there are pixels.
  EXPECT_EQ(code_of(with(whole, bytes({0x28, 0, 0x10, 0, 'U', 'S', 2, 0, 7, 0}),
                         bytes({0x28, 0, 0x10, 0, 'U', 'S', 2, 0, 8, 0}))),
            "dicom.truncated");
}

/// Writes a series of 64 x 64 pixels of 1 mm, with slices of 3 mm from 10 mm on, and contours on
/// them; returns the structure set's path.
std::string writeContoured(const TempFolder& folder, int seed) {
  (void)test::writeSeries(folder, "c", 8, {0, 0, 3}, [](test::DicomFile& file, int k) {
    file.rows = 64;
    file.columns = 60;
    file.spacing = "1\\0.9";
    file.position = "1.05\\2.1\\" + std::to_string(10 + 3 * k);
  });
  const std::string file = folder.path("c/structures.dcm");
  (void)askScript(kStructuresOracle, "write_contours", {std::to_string(seed), "8", file});
  return file;
}

TEST(DicomContours, OnTheirSeriesAreFilledAsNumpyFillsThem) {
  for (const int seed : {1, 2, 3}) {
    const TempFolder folder;
    const std::string file = writeContoured(folder, seed);
    const Image image = readImage(file);
    EXPECT_EQ(image.size, (std::array<int, 3>{60, 64, 8}));
    EXPECT_EQ(image.labels.names, (NameTable{{1, "roi 3"}, {2, "roi 4"}, {3, "roi 8"}}));
    EXPECT_EQ(image.labels.colors.at(2), (LabelColor{1.0F, 0.0F, 0.2F}));
    EXPECT_EQ(readLabelCodes(file).at(3).value, "10200004");
    test::expectLabelsAt(
        image, askScript(kStructuresOracle, "contours", {file, folder.path("c"), "1000", "4"}),
        1000);
    EXPECT_EQ(readImageInfo(file).size, image.size);
    // The folder itself still means the series of slices.
    EXPECT_EQ(readImage(folder.path("c")).labels.names.size(), 0U);
  }
}

TEST(DicomContours, WithoutTheirSeriesHaveAGridOfTheirOwn) {
  const TempFolder folder;
  const std::string file = writeContoured(folder, 1);
  const std::string moved = folder.file("alone.dcm", textOf(file));
  const Image alone = readImage(moved);
  EXPECT_TRUE(std::any_of(alone.notes.begin(), alone.notes.end(), [](const std::string& note) {
    return note.find("not in the folder") != std::string::npos;
  }));
  for (const auto& [label, name] : alone.labels.names) {
    // Give it priority, so that it gets the voxels that it shares with others.
    ImageOptions options;
    options.priority = {name};
    const auto cubic_mm = [&, of = static_cast<float>(label)](const std::string& path) {
      const Image image = readImage(path, options);
      return static_cast<double>(std::count(image.values.begin(), image.values.end(), of)) *
             std::abs(glm::determinant(image.axes)) * 1e9;
    };
    // 250 mm^2 on each of 6 slices, with an outline of 60 to 90 mm in pixels of 1 mm: the random
    // error of a slice is a few mm^2.
    EXPECT_NEAR(cubic_mm(moved) / cubic_mm(file), 1.0, 0.03) << name;
  }
}

TEST(DicomContours, BetweenSlicesOrMiscountedAreRefused) {
  const TempFolder folder;
  const std::string file = writeContoured(folder, 1);
  const std::string whole = textOf(file);
  const auto problem_of = [&](const std::string& text) {
    return errorOf([&] { (void)readImage(folder.file("c/bad.dcm", text)); }).problem();
  };
  const Problem between = problem_of(with(whole, "\\13.000000", "\\14.500000"));
  EXPECT_EQ(between.code, "dicom.contours");
  EXPECT_NE(between.message.find("'roi 3' lies between two slices"), std::string::npos)
      << between.message;
  EXPECT_EQ(problem_of(with(whole, "\\13.000000", "\\13.000000\\")).code, "dicom.damaged");
  EXPECT_EQ(problem_of(with(whole, "\\13.000000\\", "\\13\\000000\\")).code, "dicom.contours");
  for (std::size_t length = 132; length < whole.size(); length += 997) {
    const Error error = errorOf([&] {
      (void)readImage(folder.file("c/bad.dcm", std::string_view(whole).substr(0, length)));
    });
    EXPECT_EQ(error.kind(), ErrorKind::kInput) << length;
  }
}

// Bytes changed at random: a file is either read or refused.
TEST(DicomStructures, WithAnyByteChangedAreReadOrRefused) {
  const TempFolder folder;
  const std::string segments = folder.path("seg.dcm");
  (void)askScript(kStructuresOracle, "write_seg", {writeVolume(folder, 4), "implicit", segments});
  const std::string contours = writeContoured(folder, 4);
  std::size_t refused = 0;
  for (const std::string& whole : {textOf(segments), textOf(contours)}) {
    std::mt19937 random(11);
    for (int n = 0; n < 300; ++n) {
      std::string changed = whole;
      for (auto bytes = 1 + random() % 3; bytes > 0; --bytes) {
        changed[132 + random() % (changed.size() - 132)] = static_cast<char>(random() % 256);
      }
      const std::string file = folder.file("changed.dcm", changed);
      try {
        (void)readLabelCodes(file);
        (void)readImage(file);
      } catch (const Error& error) {
        ++refused;
        EXPECT_EQ(error.problem().file, file) << error.what();
      }
    }
  }
  // Most bytes are pixels and digits, but not all of them.
  EXPECT_GT(refused, 60U);
}

}  // namespace
}  // namespace palpate::vdb
