// DICOM series: places of slices, their values, and files that are refused. scans_test.cpp compares
// with pydicom and ITK.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

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
