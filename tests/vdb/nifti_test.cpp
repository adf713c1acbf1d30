// NIfTI images compared with nibabel and scipy: places of voxels, their values, and values between
// them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "palpate/core/error.h"
#include "palpate/vdb/image.h"
#include "support/scan_folder.h"
#include "vdb/made_scans.h"
#include "vdb/nifti_writer.h"
#include "vdb/python_oracle.h"

namespace palpate::vdb {
namespace {

using test::bytesOf;
using test::gzipped;
using test::NiftiFile;
using test::writeTemporary;

const std::string kData = palpate::testing::scansFolder();
const std::string kMricron = "/usr/share/mricron/templates";

std::vector<std::string> niftiFilesBelow(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().string().ends_with(".nii.gz")) files.push_back(entry.path().string());
  }
  return files;
}

/// Largest distance [mm] between our and nibabel's place of a corner of the image.
double worstCorner(const std::array<int, 3>& size, const Mat3& axes, const Vec3& origin,
                   const std::vector<double>& nibabel) {
  double worst = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index((corner & 1) * (size[0] - 1), (corner >> 1 & 1) * (size[1] - 1),
                     (corner >> 2 & 1) * (size[2] - 1));
    const Vec3 ours = (axes * index + origin) * 1e3;
    for (int row = 0; row < 3; ++row) {
      const double* r = &nibabel[static_cast<std::size_t>(4 * row)];
      const double theirs = r[0] * index.x + r[1] * index.y + r[2] * index.z + r[3];
      worst = std::max(worst, std::abs(ours[row] - theirs));
    }
  }
  return worst;
}

// Affines are float32 in the file, and both sides convert them to double, so that only the qform's
// square root and products can differ: far less than 1e-5 mm.
void expectAffinesAsNibabel(const std::vector<std::string>& files) {
  ASSERT_FALSE(files.empty());
  const auto affines = test::askPython("affine", files);
  ASSERT_EQ(affines.size(), files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    ASSERT_EQ(affines[i].size(), 12U);
    const ImageInfo info = readNiftiInfo(files[i]);
    EXPECT_LT(worstCorner(info.size, info.axes, info.origin, affines[i]), 1e-5) << files[i];
  }
}

TEST(Nifti, AffinesOfTheSharedScansAreNibabels) {
  PALPATE_NEEDS_SCAN(kData);
  expectAffinesAsNibabel(niftiFilesBelow(kData));
}

TEST(Nifti, AffinesOfMricronsTemplatesAreNibabels) {
  // In most files that set both forms, these contradict each other (a qform without its offset, a
  // mirrored axis), and the reader must not guess.
  std::vector<std::string> agreeing;
  const std::vector<std::string> files = niftiFilesBelow(kMricron);
  const auto conflicts = test::askPython("conflict", files);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (conflicts.at(i).at(0) <= 0.1) {
      agreeing.push_back(files[i]);
      continue;
    }
    try {
      (void)readNiftiInfo(files[i]);
      ADD_FAILURE() << files[i] << ": a conflict of sform and qform was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, "nifti.affine_conflict") << error.what();
    }
  }
  EXPECT_LT(agreeing.size(), files.size());
  expectAffinesAsNibabel(agreeing);
}

TEST(Nifti, AffinesFromQuaternionsAreNibabels) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<std::string> files;
  for (int i = 0; i < 24; ++i) {
    NiftiFile file;
    file.version = 1 + i % 2;
    file.sform_code = 0;
    file.qform_code = 1;
    // Points of the unit ball; on its surface (a half turn) tools round differently.
    do {
      for (double& q : file.quaternion) q = uniform(random);
    } while (std::hypot(file.quaternion[0], file.quaternion[1], file.quaternion[2]) > 0.99);
    file.q_offset = {100 * uniform(random), 100 * uniform(random), 100 * uniform(random)};
    file.pixdim = {i % 3 == 0 ? -1.0 : 1.0, 0.7, 1.3, 2.9};
    files.push_back(writeTemporary("q" + std::to_string(i) + ".nii", bytesOf(file)));
  }
  expectAffinesAsNibabel(files);
}

void expectInterpolatedAsScipyDoes(const std::string& path) {
  const Image image = readNifti(path);
  std::mt19937 random(11);
  std::vector<Vec3> points;
  std::string text;
  for (int i = 0; i < 200; ++i) {
    Vec3 index;
    for (int a = 0; a < 3; ++a) {
      index[a] = std::uniform_real_distribution<double>(
          0.0, image.size[static_cast<std::size_t>(a)] - 1.0)(random);
    }
    if (i % 10 == 0) index = glm::round(index);  // voxel centers too
    points.push_back(image.toWorld(index));
    char line[128];
    std::snprintf(line, sizeof line, "%.17g %.17g %.17g\n", points.back().x * 1e3,
                  points.back().y * 1e3, points.back().z * 1e3);
    text += line;
  }
  const auto expected = test::askPython("interpolate", {path, writeTemporary("points.txt", text)});
  ASSERT_EQ(expected.size(), points.size());
  double brightest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    // The same formula, with gray values up to some thousand: round-off of the index (1e-13) times
    // the steepest step.
    EXPECT_NEAR(image.interpolate(points[i]), expected[i].at(0), 1e-8) << i;
    brightest = std::max(brightest, expected[i][0]);
  }
  EXPECT_GT(brightest, 50.0);  // this is not a comparison of background only
}

TEST(Nifti, InterpolatesAMadeLimbAsScipyDoes) {
  const palpate::testing::TempFolder folder;
  expectInterpolatedAsScipyDoes(test::writeNifti(
      test::Limb().scan(test::obliqueAxes(Vec3(-1.1, 0.9, 1.7))), folder, "limb.nii.gz"));
}

TEST(Nifti, InterpolatesAnObliqueScanAsScipyDoes) {
  const std::string path = kData + "/orientation_pair/FLAIR.nii.gz";
  PALPATE_NEEDS_SCAN(path);
  expectInterpolatedAsScipyDoes(path);
}

TEST(Nifti, InterpolatesUpToTheOutermostCentersAndNotBeyond) {
  const Image image = readNifti(writeTemporary("a.nii", bytesOf({})));
  const Vec3 last(3, 4, 5);
  // Exact up to the round-off of the inverse affine.
  EXPECT_NEAR(image.interpolate(image.toWorld(Vec3(0.0))), image.at(0, 0, 0), 1e-12);
  EXPECT_NEAR(image.interpolate(image.toWorld(last)), image.at(3, 4, 5), 1e-12);
  EXPECT_NEAR(image.interpolate(image.toWorld(Vec3(0.5, 0, 5))),
              0.5 * (image.at(0, 0, 5) + image.at(1, 0, 5)), 1e-12);
  for (int a = 0; a < 3; ++a) {
    Vec3 below(1.0);
    Vec3 above(1.0);
    below[a] = -1e-3;
    above[a] = last[a] + 1e-3;
    EXPECT_TRUE(std::isnan(image.interpolate(image.toWorld(below))));
    EXPECT_TRUE(std::isnan(image.interpolate(image.toWorld(above))));
  }
  EXPECT_TRUE(std::isnan(image.interpolate(Vec3(std::nan(""), 0, 0))));
  EXPECT_TRUE(std::isnan(image.interpolate(Vec3(kInfinity, 0, 0))));
}

struct TypeCase {
  const char* name;
  int datatype;
  double lowest;
  double highest;
};

class NiftiTypes : public ::testing::TestWithParam<TypeCase> {};

TEST_P(NiftiTypes, EveryNumberTypeVersionAndByteOrderIsRead) {
  const TypeCase& type = GetParam();
  std::vector<std::string> files;
  std::vector<Image> images;
  for (int variant = 0; variant < 16; ++variant) {
    NiftiFile file;
    file.dim = {3, 4, 2};
    file.datatype = type.datatype;
    file.version = 1 + (variant & 1);
    file.big_endian = (variant & 2) != 0;
    if ((variant & 4) != 0) {
      file.slope = 0.25;
      file.intercept = -7.5;
    }
    for (int i = 0; i < 24; ++i) {
      file.values.push_back(std::trunc(type.lowest + (type.highest - type.lowest) * i / 23.0));
    }
    if ((variant & 8) != 0) file.data_offset = 1024;  // room for an extension
    const bool compress = variant % 3 == 0;
    files.push_back(writeTemporary(std::to_string(variant) + (compress ? ".nii.gz" : ".nii"),
                                   compress ? gzipped(bytesOf(file)) : bytesOf(file)));
    images.push_back(readNifti(files.back()));
    EXPECT_EQ(readNiftiInfo(files.back()).data_type, type.name);
  }
  const auto expected = test::askPython("values", files);
  for (std::size_t f = 0; f < files.size(); ++f) {
    ASSERT_EQ(expected[f].size(), 24U);
    ASSERT_EQ(images[f].values.size(), 24U);
    for (std::size_t i = 0; i < 24; ++i) {
      // We scale in double and round once to float; nibabel may do either.
      const double value = expected[f][i];
      EXPECT_NEAR(images[f].values[i], value, 1e-6 * std::max(1.0, std::abs(value)))
          << files[f] << " voxel " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, NiftiTypes,
    ::testing::Values(TypeCase{"uint8", 2, 0, 255}, TypeCase{"int8", 256, -128, 127},
                      TypeCase{"int16", 4, -32768, 32767}, TypeCase{"uint16", 512, 0, 65535},
                      TypeCase{"int32", 8, -2147483648.0, 2147483647.0},
                      TypeCase{"uint32", 768, 0, 4294967295.0},
                      TypeCase{"int64", 1024, -1e12, 1e12}, TypeCase{"uint64", 1280, 0, 1e12},
                      TypeCase{"float32", 16, -3e7, 3e7}, TypeCase{"float64", 64, -1e9, 1e9}),
    [](const auto& c) { return std::string(c.param.name); });

TEST(Nifti, ScalesSpacingAndOriginByTheUnit) {
  // A spacing of 2 units, with the first voxel at (-3, -4, -5) units.
  for (const auto& [code, meters] : {std::pair{1, 1.0}, {2, 1e-3}, {3, 1e-6}, {0, 1e-3}}) {
    NiftiFile file;
    file.units = code;
    const Image image = readNifti(writeTemporary("unit.nii", bytesOf(file)));
    EXPECT_NEAR(image.axes[1][1], 2.0 * meters, 1e-12 * meters) << code;
    EXPECT_NEAR(image.origin.z, -5.0 * meters, 1e-12 * meters) << code;
    EXPECT_EQ(image.notes.size(), code == 0 ? 1U : 0U);
    if (code == 0) {
      EXPECT_NE(image.notes.at(0).find("taken as mm"), std::string::npos);
    }
  }
}

TEST(Nifti, TellsAxisCodes) {
  NiftiFile file;
  EXPECT_EQ(readNiftiInfo(writeTemporary("ras.nii", bytesOf(file))).orientation, "RAS");
  file.sform = {{{0, -1, 0, 0}, {0, 0.1, 2, 0}, {-3, 0, 0, 0}}};
  EXPECT_EQ(readNiftiInfo(writeTemporary("ila.nii", bytesOf(file))).orientation, "ILA");
}

TEST(Nifti, KeepsShearAndHandedness) {
  NiftiFile file;
  file.sform = {{{-1, 0.3, 0, 1}, {0, 2, 0.5, 2}, {0.1, 0, 3, 3}}};
  const Image image = readNifti(writeTemporary("sheared.nii", bytesOf(file)));
  EXPECT_LT(glm::determinant(image.axes), 0.0);
  const Vec3 p = image.toWorld(Vec3(1, 2, 3)) * 1e3;
  EXPECT_NEAR(p.x, -1 + 0.6 + 1, 1e-6);
  EXPECT_NEAR(p.y, 4 + 1.5 + 2, 1e-6);
  EXPECT_NEAR(p.z, 0.1 + 9 + 3, 1e-6);
  EXPECT_NEAR(glm::length(image.toIndex(p * 1e-3) - Vec3(1, 2, 3)), 0.0, 1e-12);
}

TEST(Nifti, TakesTheSformWhereBothAgreeWithinATenthOfAVoxel) {
  NiftiFile file;
  file.qform_code = 1;
  file.pixdim = {1, 2, 2, 2};
  file.q_offset = {-3, -4, -5 + 0.15};  // 0.075 voxel off
  const Image image = readNifti(writeTemporary("both.nii", bytesOf(file)));
  EXPECT_NEAR(image.origin.z, -5e-3, 1e-12);
}

TEST(Nifti, AcceptsTrailingDimensionsOfOneAndStatistics) {
  NiftiFile file;
  file.dim = {4, 5, 6, 1, 1};
  file.intent = 3;  // t-test
  file.datatype = 16;
  EXPECT_EQ(readNifti(writeTemporary("t.nii", bytesOf(file))).size, (std::array{4, 5, 6}));
}

TEST(Nifti, ReadsGzipMembersOneAfterTheOtherAndIgnoresPadding) {
  const test::Bytes whole = bytesOf({});
  const auto half = whole.begin() + 400;
  test::Bytes joined = gzipped({whole.begin(), half});
  const test::Bytes second = gzipped({half, whole.end()});
  joined.insert(joined.end(), second.begin(), second.end());
  joined.resize(joined.size() + 100, 0);
  const Image image = readNifti(writeTemporary("members.nii.gz", joined));
  EXPECT_EQ(image.at(3, 4, 5), 119 % 100);
}

TEST(Nifti, KeepsNaNAndSaysSo) {
  NiftiFile file;
  file.datatype = 16;
  file.values.assign(120, 1.0);
  file.values[7] = std::nan("");
  const Image image = readNifti(writeTemporary("nan.nii", bytesOf(file)));
  EXPECT_TRUE(std::isnan(image.values[7]));
  ASSERT_EQ(image.notes.size(), 1U);
  EXPECT_NE(image.notes[0].find("1 voxels are NaN"), std::string::npos) << image.notes[0];
}

TEST(Nifti, TheFormThatIsAskedForCounts) {
  NiftiFile file;
  file.qform_code = 1;
  file.q_offset = {7, 8, 9};
  const std::string both = writeTemporary("conflict.nii", bytesOf(file));
  const auto origin = [&](const std::string& path, AffineChoice choice) {
    ImageOptions options;
    options.affine = choice;
    return readImage(path, options).origin * 1e3;
  };
  EXPECT_LT(glm::length(origin(both, AffineChoice::kSform) - Vec3(-3, -4, -5)), 1e-9);
  EXPECT_LT(glm::length(origin(both, AffineChoice::kQform) - Vec3(7, 8, 9)), 1e-9);
  EXPECT_EQ(origin(both, AffineChoice::kSpacing), Vec3(0.0));
  file.qform_code = file.sform_code = 0;
  file.pixdim = {-1, 2, 3, 4};
  const std::string none = writeTemporary("none.nii", bytesOf(file));
  ImageOptions options;
  options.affine = AffineChoice::kSpacing;
  EXPECT_LT(glm::length(readImage(none, options).toWorld({1, 1, 1}) * 1e3 - Vec3(2, 3, 4)), 1e-9);
  for (const AffineChoice choice : {AffineChoice::kSform, AffineChoice::kQform}) {
    options.affine = choice;
    EXPECT_THROW((void)readImage(none, options), Error);
  }
}

TEST(Nifti, OfFourDimensionsAFrameIsChosen) {
  for (const int version : {1, 2}) {
    NiftiFile file;
    file.version = version;
    file.dim = {4, 5, 6, 3};
    file.datatype = 4;
    for (int i = 0; i < 360; ++i) file.values.push_back(i);
    for (const bool gzip : {false, true}) {
      const test::Bytes bytes = bytesOf(file);
      const std::string path =
          writeTemporary(gzip ? "4d.nii.gz" : "4d.nii", gzip ? gzipped(bytes) : bytes);
      ImageOptions options;
      for (int frame = 0; frame < 3; ++frame) {
        options.frame = frame;
        const Image image = readImage(path, options);
        EXPECT_EQ(image.size, (std::array{4, 5, 6}));
        EXPECT_EQ(image.at(3, 4, 5), static_cast<float>(120 * frame + 119));
        // ITK replaces the direction by an identity here.
        EXPECT_LT(glm::length(image.origin * 1e3 - Vec3(-3, -4, -5)), 1e-9);
      }
      options.frame = 3;
      EXPECT_THROW((void)readImage(path, options), Error);
    }
  }
}

TEST(Nifti, NoiseInTheSformIsNoReasonToRefuseIt) {
  NiftiFile file;
  file.sform = {{{2, 2e-4, 0, -3}, {-3e-4, 2, 0, -4}, {0, 1e-4, 2, -5}}};
  expectAffinesAsNibabel({writeTemporary("noise.nii", bytesOf(file))});
}

TEST(Nifti, NamesOfLabelsComeOutOfTheExtension) {
  NiftiFile file;
  const std::string table =
      "<?xml version=\"1.0\"?><CaretExtension><VolumeInformation Index=\"0\"><LabelTable>\n"
      "<Label Key=\"3\" Red=\"1\" Green=\"0.5\" Blue=\"0\" Alpha=\"1\"><![CDATA[a < b]]></Label>\n"
      "<Label Key=\"-1\">skin &amp; fat</Label>\n";
  file.extension = table + "</LabelTable></VolumeInformation></CaretExtension>";
  for (const int code : {0, 30}) {
    for (const bool big : {false, true}) {
      file.extension_code = code;
      file.big_endian = big;
      file.version = big ? 2 : 1;
      const std::string path = writeTemporary("names.nii", bytesOf(file));
      const Image image = readImage(path);
      EXPECT_EQ(image.labels.names, (NameTable{{3, "a < b"}, {-1, "skin & fat"}}));
      EXPECT_EQ(image.labels.colors, (std::map<int, LabelColor>{{3, {1.0F, 0.5F, 0.0F}}}));
      EXPECT_EQ(image.at(3, 4, 5), 119 % 100);
      EXPECT_TRUE(readImageInfo(path).is_labels);
    }
  }
  file.extension_code = 6;  // an extension of another kind
  EXPECT_TRUE(readImage(writeTemporary("other.nii", bytesOf(file))).labels.names.empty());
  file.extension_code = 0;
  file.extension = table + "<Label Key=\"3\">other</Label></LabelTable>";
  EXPECT_THROW((void)readImage(writeTemporary("twice.nii", bytesOf(file))), Error);
  file.extension = table;
  EXPECT_THROW((void)readImage(writeTemporary("open.nii", bytesOf(file))), Error);
  file.extension = "<LabelTable><Label Key=\"x\">a</Label></LabelTable>";
  EXPECT_THROW((void)readImage(writeTemporary("key.nii", bytesOf(file))), Error);
  file.extension.clear();
  file.intent = 1002;
  EXPECT_TRUE(readImageInfo(writeTemporary("intent.nii", bytesOf(file))).is_labels);
}

TEST(Nifti, ReadsTheHeadOfMricron) {
  const Image head = readNifti(kMricron + "/ch2.nii.gz");
  EXPECT_EQ(head.size, (std::array{181, 217, 181}));
  EXPECT_EQ(head.notes.size(), 1U);  // unit code 0
  double largest = 0.0;
  for (const float value : head.values) largest = std::max(largest, static_cast<double>(value));
  EXPECT_GT(largest, 100.0);
  EXPECT_LE(largest, 255.0);
}

}  // namespace
}  // namespace palpate::vdb
