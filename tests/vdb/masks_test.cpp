// Masks of one structure each, in a folder or listed: they become one label image, whose voxels are
// where nibabel has them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>

#include "palpate/vdb/image.h"
#include "support/error_of.h"
#include "support/scan_folder.h"
#include "support/temp_file.h"
#include "vdb/nifti_writer.h"
#include "vdb/structure_points.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;
using test::NiftiFile;

/// Oblique, left-handed, of three spacings.
constexpr std::array<std::array<double, 4>, 3> kOblique = {
    {{-1.2, 0.3, 0.1, 31.5}, {0.28, 1.9, -0.2, -12.25}, {0.16, 0.25, 2.9, 7.0}}};

std::string write(const TempFolder& folder, const std::string& name, const NiftiFile& file) {
  const test::Bytes plain = test::bytesOf(file);
  const test::Bytes bytes = name.ends_with(".gz") ? test::gzipped(plain) : plain;
  return folder.file(name,
                     std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

/// A mask of 6 x 5 x 4 voxels in which the voxels `set` have the value `value`.
NiftiFile maskOf(const std::vector<std::size_t>& set, double value = 1.0) {
  NiftiFile file;
  file.dim = {6, 5, 4};
  file.sform = {{{2, 0, 0, -3}, {0, 2, 0, -4}, {0, 0, 2, -5}}};
  file.values.assign(120, 0.0);
  for (const std::size_t at : set) file.values[at] = value;
  return file;
}

bool hasNote(const Image& image, const std::string& text) {
  return std::any_of(image.notes.begin(), image.notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

TEST(Masks, ALabelVolumeSplitIntoThemIsReadAsItself) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto below = [&](unsigned most) { return static_cast<int>(random() % most); };
    NiftiFile whole;
    whole.dim = {3 + below(9), 3 + below(9), 3 + below(9)};
    whole.sform = kOblique;
    const int labels = 1 + below(9);
    const auto count = static_cast<std::size_t>(whole.dim[0] * whole.dim[1] * whole.dim[2]);
    // Runs of one label, as structures have, and single voxels.
    while (whole.values.size() < count) {
      const int label = below(static_cast<unsigned>(labels) + 1);
      for (int n = 1 + below(6); n > 0 && whole.values.size() < count; --n) {
        whole.values.push_back(label);
      }
    }
    const TempFolder folder;
    const Image expected = readImage(write(folder, "whole.nii", whole));
    std::filesystem::create_directory(folder.path("masks"));
    for (int label = 1; label <= labels; ++label) {
      NiftiFile mask = whole;
      const double value = label % 3 == 0 ? 255.0 : 1.0;
      for (double& v : mask.values) v = v == label ? value : 0.0;
      (void)write(folder,
                  "masks/part" + std::to_string(label) + (label % 2 == 0 ? ".nii" : ".nii.gz"),
                  mask);
    }
    const Image image = readImage(folder.path("masks"));
    EXPECT_EQ(image.size, expected.size);
    EXPECT_EQ(image.values, expected.values);
    EXPECT_EQ(image.axes, expected.axes);
    EXPECT_EQ(image.origin, expected.origin);
    ASSERT_EQ(image.labels.names.size(), static_cast<std::size_t>(labels));
    for (const auto& [label, name] : image.labels.names) {
      EXPECT_EQ(name, "part" + std::to_string(label));
    }
    const ImageInfo info = readImageInfo(folder.path("masks"));
    EXPECT_TRUE(info.is_labels);
    EXPECT_EQ(info.labels.names, image.labels.names);
    EXPECT_EQ(info.size, image.size);
  }
}

TEST(Masks, WhereTheyOverlapTheSmallestHasTheVoxelUnlessThePrioritySaysSo) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path("m"));
  (void)write(folder, "m/a_tumor.nii", maskOf({10, 11}));
  (void)write(folder, "m/b_liver.nii", maskOf({9, 10, 11, 12, 13}));
  (void)write(folder, "m/c_late.nii", maskOf({13, 14}));   // as large as the tumor
  (void)write(folder, "m/d_equal.nii", maskOf({14, 15}));  // later than the one it overlaps
  (void)write(folder, "m/e_none.nii", maskOf({}));
  const Image image = readImage(folder.path("m"));
  EXPECT_EQ((std::vector<float>(image.values.begin() + 9, image.values.begin() + 16)),
            (std::vector<float>{2, 1, 1, 2, 3, 4, 4}));
  // Four voxels of 8 mm^3 are in two masks: two of the tumor, one of each other mask.
  EXPECT_TRUE(hasNote(
      image, "4 voxels (0.032 cm^3) are in several masks; each goes to the smallest of them"))
      << image.notes.front();
  EXPECT_TRUE(hasNote(image, "a_tumor has 0.016 cm^3 of b_liver"));
  EXPECT_TRUE(hasNote(image, "c_late has 0.008 cm^3 of b_liver"));
  EXPECT_TRUE(hasNote(image, "d_equal has 0.008 cm^3 of c_late"));
  EXPECT_TRUE(hasNote(image, "1 of 5 masks have no voxel: e_none"));

  ImageOptions options;
  options.priority = {"b_liver", "c_late"};
  const Image by_name = readImage(folder.path("m"), options);
  EXPECT_EQ((std::vector<float>(by_name.values.begin() + 9, by_name.values.begin() + 16)),
            (std::vector<float>{2, 2, 2, 2, 2, 3, 4}));
  EXPECT_TRUE(hasNote(by_name, "b_liver has 0.016 cm^3 of a_tumor"));
  options.priority = {"b_live"};
  const Problem problem = errorOf([&] { (void)readImage(folder.path("m"), options); }).problem();
  EXPECT_EQ(problem.code, "labels.priority");
  EXPECT_NE(problem.hint.find("b_liver"), std::string::npos);
  // A single image of labels has nothing that a priority could order.
  EXPECT_EQ(errorOf([&] { (void)readImage(folder.path("m/a_tumor.nii"), options); }).problem().code,
            "image.option");
}

TEST(Masks, FilesMayBeListedInAnyOrderAndFormat) {
  const TempFolder folder;
  const std::string first = write(folder, "spleen.nii.gz", maskOf({5}));
  const std::string second = write(folder, "Liver.NII", maskOf({7}, 3.0));
  ImageOptions options;
  options.with = {second};
  const Image image = readImage(first, options);
  EXPECT_EQ(image.labels.names, (NameTable{{1, "spleen"}, {2, "Liver"}}));
  EXPECT_EQ(image.values[5], 1.0F);
  EXPECT_EQ(image.values[7], 2.0F);
  options.with = {folder.file("notes.txt", "no mask")};
  EXPECT_EQ(errorOf([&] { (void)readImage(first, options); }).problem().code, "masks.format");
  std::filesystem::create_directory(folder.path("other"));
  options.with = {write(folder, "other/spleen.nii", maskOf({6}))};
  const Problem problem = errorOf([&] { (void)readImage(first, options); }).problem();
  EXPECT_EQ(problem.code, "masks.name");
  EXPECT_EQ(problem.file, options.with.front());
}

TEST(Masks, OnAnotherGridAreRefusedWithTheShift) {
  const TempFolder folder;
  const std::string first = write(folder, "a.nii", maskOf({5}));
  const auto message_of = [&](const NiftiFile& other) {
    ImageOptions options;
    options.with = {write(folder, "b.nii", other)};
    std::string both;
    for (const bool header_only : {false, true}) {
      const Problem problem = errorOf([&] {
                                if (header_only) {
                                  (void)readImageInfo(first, options);
                                } else {
                                  (void)readImage(first, options);
                                }
                              }).problem();
      EXPECT_EQ(problem.code, "masks.grid");
      EXPECT_EQ(problem.file, options.with.front());
      both = problem.message;
    }
    return both;
  };
  NiftiFile shifted = maskOf({5});
  shifted.sform[0][3] += 3.0;
  shifted.sform[2][3] -= 2.0;
  EXPECT_EQ(message_of(shifted),
            "it is shifted by (3, 0, -2) mm (right, front, up), or (1.5, 0, -1) voxels, "
            "from a.nii");
  NiftiFile cropped = shifted;
  cropped.dim = {5, 5, 4};
  cropped.values.assign(100, 0.0);
  EXPECT_NE(message_of(cropped).find("5 x 5 x 4 voxels where that has 6 x 5 x 4"),
            std::string::npos);
  NiftiFile mirrored = maskOf({5});
  mirrored.sform[0][0] = -2.0;
  EXPECT_NE(
      message_of(mirrored).find("axes LAS here, 6 x 5 x 4 voxels of 2 x 2 x 2 mm, axes RAS there"),
      std::string::npos);
  // Two programs write the same place with different last digits.
  NiftiFile close = maskOf({7});
  close.sform[0][3] += 0.002;
  ImageOptions options;
  options.with = {write(folder, "b.nii", close)};
  EXPECT_EQ(readImage(first, options).values[7], 2.0F);
}

TEST(Masks, GrayValuesAndDamageAreRefusedByFileAndPlace) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path("m"));
  (void)write(folder, "m/a.nii.gz", maskOf({5}));
  NiftiFile gray = maskOf({5});
  gray.values[8] = 1.0;
  gray.values[119] = 40.0;
  const std::string file = write(folder, "m/ct.nii.gz", gray);
  const Problem problem = errorOf([&] { (void)readImage(folder.path("m")); }).problem();
  EXPECT_EQ(problem.code, "masks.values");
  EXPECT_EQ(problem.file, file);
  EXPECT_NE(problem.message.find("1 at voxel 5, 0, 0 and 40 at voxel 5, 4, 3"), std::string::npos)
      << problem.message;
  const test::Bytes whole = test::gzipped(test::bytesOf(maskOf({5})));
  for (const std::size_t length : {std::size_t{0}, whole.size() / 2, whole.size() - 1}) {
    (void)folder.file("m/ct.nii.gz",
                      std::string_view(reinterpret_cast<const char*>(whole.data()), length));
    const Error error = errorOf([&] { (void)readImage(folder.path("m")); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problem().file, file) << error.what();
  }
  // Files that a file manager or another program left there are ignored.
  std::filesystem::remove(file);
  (void)folder.file("m/._a.nii.gz", "not an image");
  (void)folder.file("m/statistics.json", "{}");
  EXPECT_EQ(readImage(folder.path("m")).labels.names.size(), 1U);
}

TEST(Masks, OfAScanLieWhereNibabelHasThem) {
  const std::string labels = palpate::testing::scanPath("abdomen/example_seg.nii.gz");
  PALPATE_NEEDS_SCAN(labels);
  const TempFolder folder;
  (void)test::askScript(test::kStructuresOracle, "split", {labels, folder.path()});
  const Image image = readImage(folder.path());
  EXPECT_EQ(image.labels.names.size(), 61U);
  test::expectLabelsAt(
      image, test::askScript(test::kStructuresOracle, "masks", {folder.path(), "1000", "5"}), 1000);
  // The files are named by label and sorted by name: the volume that they were made from has the
  // same order.
  const Image whole = readImage(labels);
  for (std::size_t v = 0; v < whole.values.size(); ++v) {
    if (whole.values[v] == 0.0F) {
      ASSERT_EQ(image.values[v], 0.0F);
      continue;
    }
    char name[16];
    std::snprintf(name, sizeof name, "s%03d", static_cast<int>(whole.values[v]));
    ASSERT_EQ(image.labels.names.at(static_cast<int>(image.values[v])), name);
  }
}

// Slicer's segments in shared layers, and the same in the form of older programs, with one layer
// for each.
TEST(Segments, OfBothKindsLieWhereNumpyHasThem) {
  const std::string newer =
      palpate::testing::scanPath("chest_segnrrd/SegmentationOverlapping.seg.nrrd");
  PALPATE_NEEDS_SCAN(newer);
  const TempFolder folder;
  const std::string older = folder.path("older.seg.nrrd");
  (void)test::askScript(test::kStructuresOracle, "write_older", {newer, older});
  const std::vector<std::string> names = {"ribs",
                                          "cervical vertebral column",
                                          "thoracic vertebral column",
                                          "lumbar vertebral column",
                                          "right lung",
                                          "left lung",
                                          "tissue",
                                          "overlapping sphere"};
  std::map<std::string, LabelColor> colors[2];
  for (const std::string& file : {newer, older}) {
    SCOPED_TRACE(file);
    Image image = readImage(file);
    ASSERT_EQ(image.labels.names.size(), names.size());
    EXPECT_TRUE(hasNote(image, "15514 voxels"));
    EXPECT_TRUE(hasNote(image, "overlapping sphere has"));
    std::map<float, float> number_of = {{0.0F, 0.0F}};
    for (const auto& [label, name] : image.labels.names) {
      const auto at = std::find(names.begin(), names.end(), name);
      ASSERT_NE(at, names.end()) << name;
      number_of[static_cast<float>(label)] = static_cast<float>(at - names.begin() + 1);
      colors[file == older ? 1 : 0][name] = image.labels.colors.at(label);
    }
    for (float& value : image.values) value = number_of.at(value);
    test::expectLabelsAt(
        image, test::askScript(test::kStructuresOracle, "nrrd", {file, "1000", "6"}), 1000);
  }
  EXPECT_EQ(colors[0], colors[1]);
}

}  // namespace
}  // namespace palpate::vdb
