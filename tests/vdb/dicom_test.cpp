// DICOM series: places of slices, their values, and files that are refused. scans_test.cpp compares
// with pydicom and ITK.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "palpate/vdb/image.h"
#include "support/error_of.h"
#include "vdb/dicom_writer.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;
using test::DicomFile;
using test::writeSeries;

const auto kAsItIs = [](DicomFile&, int) {};

/// Distance between two points [mm].
double apartMm(const Vec3& a, const Vec3& b) { return glm::length(a - b) * 1e3; }

TEST(Dicom, PlacesSlicesByPositionAndSpacingByRowAndColumn) {
  const TempFolder folder;
  const std::string path = writeSeries(folder, "s", 5, {0, 0, 3}, [](DicomFile& file, int k) {
    file.with_sequence = true;
    file.is_implicit = k % 2 == 1;
    file.pixels.assign(24, 0);
    file.pixels[6 * 2 + 4] = 100 + k;  // row 2, column 4
  });
  for (const std::string& name : {path, path + "/90.dcm"}) {
    const Image image = readImage(name);
    EXPECT_EQ(image.size, (std::array{6, 4, 5}));
    for (int k = 0; k < 5; ++k) {
      // Stored 100 + k, minus 1000; column 4 is 4 * 0.5 mm to the left, row 2 is 2 * 2 mm to the
      // back.
      EXPECT_EQ(image.at(4, 2, k), static_cast<float>(100 + k - 1000));
      EXPECT_LT(apartMm(image.toWorld({4, 2, k}), Vec3(-12, -14, 10 + 3 * k) * 1e-3), 1e-9);
    }
    EXPECT_EQ(image.at(0, 0, 0), -1000.0F);
    EXPECT_TRUE(image.notes.empty());
  }
  const ImageInfo info = readImageInfo(path);
  EXPECT_EQ(info.orientation, "LPS");
  EXPECT_EQ(info.data_type, "int16");
  EXPECT_EQ(info.format, "DICOM series, CT");
}

TEST(Dicom, AnObliqueSeriesFromFeetToHeadAndBackIsOneGeometry) {
  const TempFolder folder;
  // Rows along (0.8, 0.6, 0), columns along (0, 0, -1): the normal is (-0.6, 0.8, 0).
  const auto oblique = [](DicomFile& file, int) { file.orientation = "0.8\\0.6\\0\\0\\0\\-1"; };
  const Image image = readImage(writeSeries(folder, "s", 4, {-1.2, 1.6, 0}, oblique));
  EXPECT_LT(apartMm(image.toWorld({0, 0, 0}), Vec3(-10, -10, 10) * 1e-3), 1e-9);
  EXPECT_LT(
      apartMm(image.toWorld({2, 1, 3}), Vec3(-(10 + 0.8 - 3.6), -(10 + 0.6 + 4.8), 10 - 2) * 1e-3),
      1e-9);
  // With files in reverse order the places are the same: slices are sorted along the normal.
  const Image back = readImage(writeSeries(folder, "t", 4, {1.2, -1.6, 0}, oblique));
  EXPECT_LT(apartMm(back.toWorld({0, 0, 3}), Vec3(-10, -10, 10) * 1e-3), 1e-9);
}

// A tilted gantry: the slices are rectangular in their own plane, and move along the table. ITK
// would make a box of them.
TEST(Dicom, ATiltedGantryShearsTheVoxels) {
  const TempFolder folder;
  const double tilt = 12.0 * std::acos(-1.0) / 180.0;
  const auto tilted = [&](DicomFile& file, int) {
    char text[96];
    std::snprintf(text, sizeof text, "1\\0\\0\\0\\%.12f\\%.12f", std::cos(tilt), std::sin(tilt));
    file.orientation = text;
    file.tilt = "12";
  };
  const Image image = readImage(writeSeries(folder, "s", 6, {0, 0, 2.5}, tilted));
  EXPECT_LT(apartMm(image.axes[2], Vec3(0, 0, 2.5e-3)), 1e-9);
  EXPECT_LT(apartMm(image.axes[1], Vec3(0, -std::cos(tilt), std::sin(tilt)) * 2e-3), 1e-9);
  ASSERT_EQ(image.notes.size(), 1U);
  EXPECT_NE(image.notes[0].find("sheared by 12 degrees"), std::string::npos) << image.notes[0];
  // The header states a tilt, the positions do not: a note says so, and the positions count.
  const auto said = [](DicomFile& file, int) { file.tilt = "-12.0"; };
  const Image straight = readImage(writeSeries(folder, "t", 4, {0, 0, 2}, said));
  ASSERT_EQ(straight.notes.size(), 1U);
  EXPECT_NE(straight.notes[0].find("GantryDetectorTilt"), std::string::npos);
}

TEST(Dicom, StoredBitsSignAndScaleMakeTheValue) {
  const TempFolder folder;
  const Image image = readImage(writeSeries(folder, "s", 2, {0, 0, 1}, [](DicomFile& file, int k) {
    file.bits_stored = 12;
    file.is_signed = k == 0;
    file.slope = k == 0 ? "2" : "0.5";  // differs from slice to slice, as in PET
    file.intercept = "1";
    file.pixels.assign(24, 0x0FFF);
    file.pixels[1] = 0xF001;  // bits above the stored ones do not count
  }));
  EXPECT_EQ(image.at(0, 0, 0), -1.0F);            // -1 * 2 + 1
  EXPECT_EQ(image.at(1, 0, 0), 3.0F);             // 1 * 2 + 1
  EXPECT_EQ(image.at(0, 0, 1), 4095 * 0.5F + 1);  // unsigned
  EXPECT_EQ(image.at(1, 0, 1), 1.5F);
}

TEST(Dicom, OfSeveralSeriesOneMustBeChosen) {
  const TempFolder folder;
  const auto two = [](DicomFile& file, int k) {
    file.series = k < 3 ? "1.2.3" : "1.2.4";
    file.intercept = k < 3 ? "0" : "500";
  };
  const std::string path = writeSeries(folder, "s", 6, {0, 0, 1}, two);
  const Problem problem = errorOf([&] { (void)readImage(path); }).problem();
  EXPECT_EQ(problem.code, "dicom.series");
  EXPECT_NE(problem.message.find("1.2.3 (3 files), 1.2.4 (3 files)"), std::string::npos);
  ImageOptions options;
  options.series = "1.2.4";
  EXPECT_EQ(readImage(path, options).at(0, 0, 0), 500.0F);
  // A file stands for its series.
  EXPECT_EQ(readImage(path + "/90.dcm").at(0, 0, 0), 0.0F);
  options.series = "9";
  EXPECT_EQ(errorOf([&] { (void)readImage(path, options); }).problem().code, "dicom.series");
}

TEST(Dicom, AReportBesideTheSlicesIsPassedOverAndASliceWithoutPixelsIsNot) {
  const TempFolder folder;
  const std::string path = writeSeries(folder, "s", 4, {0, 0, 1}, kAsItIs);
  DicomFile report;
  report.with_pixels = false;
  report.storage_class = "1.2.840.10008.5.1.4.1.1.88.11";
  (void)folder.file("s/report", bytesOf(report));
  const Image image = readImage(path);
  EXPECT_EQ(image.size[2], 4);
  ASSERT_EQ(image.notes.size(), 1U);
  EXPECT_NE(image.notes[0].find("1 DICOM files without pixels"), std::string::npos);
  report.storage_class = "1.2.840.10008.5.1.4.1.1.2";
  (void)folder.file("s/report", bytesOf(report));
  EXPECT_EQ(errorOf([&] { (void)readImage(path); }).problem().code, "dicom.truncated");
}

/// Writes a series whose slices lie anywhere, and knows its values: at each voxel's center that of
/// a field that is linear in the world, rounded to 1/1000.
class LooseSeries {
 public:
  static constexpr int kColumns = 6;
  static constexpr int kRows = 4;

  /// `shift`: the most by which a slice lies beside the first [voxels].
  LooseSeries(const TempFolder& folder, unsigned seed, double shift) {
    std::mt19937 random(seed);
    const auto any = [&](double a, double b) {
      return std::uniform_real_distribution<double>(a, b)(random);
    };
    const double turn = any(0.0, 6.0);
    const Vec3 right(std::cos(turn), std::sin(turn), 0.0);
    const Vec3 down = glm::normalize(Vec3(-right.y, right.x, any(-1.0, 1.0)));
    slope_ = Vec3(any(-0.3, 0.3), any(-0.3, 0.3), any(-0.3, 0.3));
    Vec3 position(10.0, -5.0, 3.0);
    path_ = writeSeries(folder, std::to_string(seed), 7, {0, 0, 1}, [&](DicomFile& file, int k) {
      const auto list = [](std::initializer_list<double> numbers) {
        std::string text;
        for (const double x : numbers) {
          char digits[32];
          std::snprintf(digits, sizeof digits, "%.12f", x);
          text += (text.empty() ? "" : "\\") + std::string(digits);
        }
        return text;
      };
      if (k > 0) {
        position += any(0.5, 3.0) * glm::cross(right, down) +
                    any(-shift, shift) * (0.5 * right + 2.0 * down);
      }
      places_.push_back(position);
      file.position = list({position.x, position.y, position.z});
      file.orientation = list({right.x, right.y, right.z, down.x, down.y, down.z});
      file.slope = "0.001";
      file.intercept = "0";
      for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
          const Vec3 at = position + 0.5 * column * right + 2.0 * row * down;
          file.pixels.push_back(static_cast<int>(std::lround(1000.0 * value(at))));
        }
      }
    });
  }

  [[nodiscard]] const std::string& path() const { return path_; }
  /// The field at a place in the file's own coordinates [mm].
  [[nodiscard]] double value(const Vec3& at) const { return glm::dot(slope_, at); }
  [[nodiscard]] const std::vector<Vec3>& places() const { return places_; }

 private:
  std::string path_;
  Vec3 slope_{0.0};
  std::vector<Vec3> places_;
};

ImageOptions resamplingOn() {
  ImageOptions options;
  options.resample = true;
  return options;
}

TEST(DicomResampled, ALinearFieldIsTheSameFieldWhereverTheSlicesLie) {
  const TempFolder folder;
  int known = 0;
  int unknown = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const LooseSeries series(folder, seed, seed % 2 == 0 ? 0.0 : 1.5);
    EXPECT_EQ(errorOf([&] { (void)readImage(series.path()); }).problem().code, "dicom.spacing");
    const Image image = readImage(series.path(), resamplingOn());
    const ImageInfo info = readImageInfo(series.path(), resamplingOn());
    EXPECT_EQ(info.size, image.size);
    EXPECT_EQ(info.origin, image.origin);
    // Right angles, and the slices' own spacing across.
    EXPECT_NEAR(glm::dot(image.axes[0], image.axes[2]), 0.0, 1e-15);
    EXPECT_NEAR(glm::dot(image.axes[1], image.axes[2]), 0.0, 1e-15);
    EXPECT_NEAR(glm::length(image.axes[0]), 0.5e-3, 1e-12);
    EXPECT_NEAR(glm::length(image.axes[1]), 2e-3, 1e-12);
    const Vec3 normal = glm::normalize(image.axes[2]);
    for (int k = 0; k < image.size[2]; ++k) {
      for (int j = 0; j < image.size[1]; ++j) {
        for (int i = 0; i < image.size[0]; ++i) {
          const Vec3 ras = 1e3 * image.toWorld({i, j, k});
          const float value = image.at(i, j, k);
          if (std::isnan(value)) {
            ++unknown;
            EXPECT_EQ(seed % 2, 1U) << "slices that lie straight hold all voxels";
            continue;
          }
          ++known;
          // Rounded to 1/1000 when it was stored.
          ASSERT_NEAR(value, series.value({-ras.x, -ras.y, ras.z}), 0.55e-3) << seed;
        }
      }
    }
    // The image reaches from the first slice to the last, and no slice has a corner outside it.
    const auto height = [&](const Vec3& lps) {
      return glm::dot(1e-3 * Vec3(-lps.x, -lps.y, lps.z) - image.origin, normal);
    };
    EXPECT_NEAR(height(series.places().front()), 0.0, 1e-12);
    EXPECT_NEAR(height(series.places().back()), glm::length(image.axes[2]) * (image.size[2] - 1),
                1e-12);
    for (const Vec3& place : series.places()) {
      const Vec3 index = image.toIndex(1e-3 * Vec3(-place.x, -place.y, place.z));
      EXPECT_GT(index.x, -1e-3);
      EXPECT_GT(index.y, -1e-3);
      EXPECT_LT(index.x, image.size[0] - LooseSeries::kColumns + 1e-3);
      EXPECT_LT(index.y, image.size[1] - LooseSeries::kRows + 1e-3);
    }
    ASSERT_GE(image.notes.size(), 1U);
    EXPECT_NE(image.notes[0].find("resampled on"), std::string::npos) << image.notes[0];
  }
  EXPECT_GT(known, 40 * 6 * 4 * 4);  // whole slices, four of seven at least
  EXPECT_GT(unknown, 500);
}

TEST(DicomResampled, ATiltedSeriesGetsRightAnglesAndAnEvenOneStaysAsItIs) {
  const TempFolder folder;
  const std::string tilted = writeSeries(folder, "t", 5, {0, 0.5, 2}, kAsItIs);
  EXPECT_GT(std::fabs(glm::dot(readImage(tilted).axes[1], readImage(tilted).axes[2])), 1e-7);
  const Image straight = readImage(tilted, resamplingOn());
  EXPECT_NEAR(glm::dot(straight.axes[1], straight.axes[2]), 0.0, 1e-15);
  EXPECT_EQ(straight.size, (std::array{6, 5, 5}));  // a voxel more, for 4 slices times 0.5 of 2 mm
  EXPECT_NE(straight.notes[0].find("sheared by 14"), std::string::npos) << straight.notes[0];

  const std::string even = writeSeries(folder, "e", 5, {0, 0, 2}, kAsItIs);
  const Image plain = readImage(even);
  const Image asked = readImage(even, resamplingOn());
  EXPECT_EQ(asked.values, plain.values);
  EXPECT_EQ(asked.axes, plain.axes);
  EXPECT_TRUE(asked.notes.empty());
}

TEST(DicomResampled, AMissingSliceIsFilledInAndItsErrorIsStated) {
  // Values z^2: a curvature of 2, so that in the middle of a gap of 4 mm linear values are off by
  // 2 * 4^2 / 8 = 4.
  const TempFolder folder;
  const std::string path = writeSeries(folder, "s", 6, {0, 0, 2}, [](DicomFile& file, int k) {
    const int z = 2 * (k < 3 ? k : k + 1);
    file.position = "0\\0\\" + std::to_string(z);
    file.intercept = "0";
    file.pixels.assign(24, z * z);
  });
  const Image image = readImage(path, resamplingOn());
  ASSERT_EQ(image.size, (std::array{6, 4, 7}));
  EXPECT_EQ(image.at(2, 2, 3), 40.0F);  // between 16 and 64, where 36 would be right
  EXPECT_EQ(image.at(2, 2, 4), 64.0F);
  ASSERT_EQ(image.notes.size(), 2U);
  EXPECT_NE(image.notes[0].find("a slice may be missing: resampled on 6 x 4 x 7 voxels"),
            std::string::npos)
      << image.notes[0];
  EXPECT_NE(image.notes[1].find("off by about 4 (RMS)"), std::string::npos) << image.notes[1];
}

TEST(DicomResampled, OnlySeriesAre) {
  const TempFolder folder;
  const std::string mask = folder.file("a.nii.gz", "");
  EXPECT_EQ(errorOf([&] { (void)readImage(mask, resamplingOn()); }).problem().code, "image.option");
}

struct BadSeries {
  const char* name;
  const char* code;
  const char* says;
  std::function<void(DicomFile&, int)> spoil;
};

class DicomErrors : public ::testing::TestWithParam<BadSeries> {};

TEST_P(DicomErrors, AreNamed) {
  const TempFolder folder;
  const std::string path = writeSeries(folder, "s", 6, {0, 0, 1.5}, GetParam().spoil);
  for (const bool header_only : {false, true}) {
    const Error error = errorOf([&] {
      if (header_only) {
        (void)readImageInfo(path);
      } else {
        (void)readImage(path);
      }
    });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problem().code, GetParam().code) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(All, DicomErrors,
                         ::testing::Values(
                             // ITK only warns, and stretches the spacing.
                             BadSeries{"MissingSlice", "dicom.spacing", "a slice may be missing",
                                       [](DicomFile& f, int k) {
                                         if (k >= 3)
                                           f.position =
                                               "10\\10\\" + std::to_string(10 + 1.5 * (k + 1));
                                       }},
                             BadSeries{"UnevenSlice", "dicom.spacing", "not evenly spaced",
                                       [](DicomFile& f, int k) {
                                         if (k == 2) f.position = "10\\10\\13.2";
                                       }},
                             BadSeries{"SliceAside", "dicom.spacing", "off the line",
                                       [](DicomFile& f, int k) {
                                         if (k == 2) f.position = "11\\10\\13";
                                       }},
                             BadSeries{"Twice", "dicom.duplicate", "same place",
                                       [](DicomFile& f, int k) {
                                         if (k == 3) f.position = "10\\10\\13";
                                       }},
                             BadSeries{"OtherOrientation", "dicom.mixed", "orientation",
                                       [](DicomFile& f, int k) {
                                         if (k == 5) f.orientation = "0\\1\\0\\-1\\0\\0";
                                       }},
                             BadSeries{"OtherSize", "dicom.mixed", "rows",
                                       [](DicomFile& f, int k) {
                                         if (k == 1) f.rows = 5;
                                       }},
                             BadSeries{"OtherSpacing", "dicom.mixed", "pixel spacing",
                                       [](DicomFile& f, int k) {
                                         if (k == 1) f.spacing = "2\\0.6";
                                       }},
                             BadSeries{
                                 "NotUnit", "dicom.orientation", "unit vectors",
                                 [](DicomFile& f, int) { f.orientation = "2\\0\\0\\0\\1\\0"; }},
                             BadSeries{"NoPosition", "dicom.no_affine", "ImagePositionPatient",
                                       [](DicomFile& f, int k) {
                                         if (k == 4) f.position.clear();
                                       }},
                             BadSeries{"NoSpacing", "dicom.no_affine", "PixelSpacing",
                                       [](DicomFile& f, int) { f.spacing.clear(); }},
                             BadSeries{"BadNumber", "dicom.value", "(0020,0032)",
                                       [](DicomFile& f, int k) {
                                         if (k == 4) f.position = "10\\x\\3";
                                       }},
                             BadSeries{"ShortPixels", "dicom.truncated", "asks for 48",
                                       [](DicomFile& f, int k) {
                                         if (k == 4) f.pixel_bytes_off = -6;
                                       }},
                             BadSeries{"LongPixels", "dicom.pixels", "holds 60 bytes",
                                       [](DicomFile& f, int k) {
                                         if (k == 4) f.pixel_bytes_off = 12;
                                       }},
                             BadSeries{"Frames", "dicom.multiframe", "12 frames",
                                       [](DicomFile& f, int) { f.frames = "12"; }},
                             BadSeries{"Color", "dicom.data_type", "RGB",
                                       [](DicomFile& f, int) { f.photometric = "RGB"; }}),
                         [](const auto& c) { return std::string(c.param.name); });

// GDCM fills in missing pixels, and ends the process if the header is truncated.
TEST(DicomCut, AnywhereIsRefused) {
  const TempFolder folder;
  DicomFile file;
  file.with_sequence = true;
  const std::string whole = bytesOf(file);
  const std::string path = writeSeries(folder, "s", 4, {0, 0, 1}, kAsItIs);
  for (std::size_t length = 140; length < whole.size(); length += 1) {
    (void)folder.file("s/90.dcm", whole.substr(0, length));
    EXPECT_THROW((void)readImage(path), Error) << length << " of " << whole.size();
  }
}

TEST(DicomCut, FoldersWithoutASeriesAreNoImages) {
  const TempFolder folder;
  EXPECT_EQ(errorOf([&] { (void)readImage(folder.path("none.dcm")); }).problem().code,
            "dicom.missing");
  (void)folder.file("text.txt", "no image");
  EXPECT_EQ(errorOf([&] { (void)readImage(folder.path()); }).problem().code, "dicom.missing");
  EXPECT_EQ(errorOf([&] { (void)readImage(folder.file("x.dcm", "no DICOM")); }).problem().code,
            "dicom.format");
  const std::string one = writeSeries(folder, "one", 1, {0, 0, 1}, kAsItIs);
  EXPECT_EQ(errorOf([&] { (void)readImage(one); }).problem().code, "dicom.dimensions");
  // A slope of 0 is noticed only when voxels are read.
  const auto flat = [](DicomFile& f, int) { f.slope = "0"; };
  const std::string zero = writeSeries(folder, "zero", 3, {0, 0, 1}, flat);
  EXPECT_EQ(errorOf([&] { (void)readImage(zero); }).problem().code, "dicom.value");
}

}  // namespace
}  // namespace palpate::vdb
