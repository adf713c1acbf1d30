// NRRD files made by hand: places, encodings, segments, and files that are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "palpate/vdb/image.h"
#include "support/error_of.h"
#include "support/temp_file.h"
#include "vdb/header_lines.h"
#include "vdb/nifti_writer.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;

using test::apartMm;
using test::counting;
using test::expectCounting;
using test::Lines;
using test::set;

Lines plainHeader() {
  return {{"type", "short"},
          {"dimension", "3"},
          {"space", "left-posterior-superior"},
          {"sizes", "4 3 2"},
          {"space directions", "(1,0,0) (0,2,0) (0,0,3)"},
          {"kinds", "domain domain domain"},
          {"endian", "little"},
          {"encoding", "raw"},
          {"space origin", "(10,20,30)"}};
}

std::string textOf(const Lines& lines) {
  std::string text = "NRRD0004\n# made by hand\n";
  for (const auto& [key, value] : lines) {
    if (value != "-") text += key + (key.starts_with("Segment") ? ":=" : ": ") + value + "\n";
  }
  return text + "\n";
}

std::string zipped(const std::string& content) {
  const test::Bytes bytes = test::gzipped(test::Bytes(content.begin(), content.end()));
  return {bytes.begin(), bytes.end()};
}

TEST(Nrrd, EveryEncodingAndByteOrderGivesTheSameVoxels) {
  const TempFolder folder;
  Lines lines = plainHeader();
  std::vector<std::string> files = {folder.file("raw.nrrd", textOf(lines) + counting(24))};
  set(lines, "encoding", "gzip");
  files.push_back(folder.file("gz.nrrd", textOf(lines) + zipped(counting(24))));
  set(lines, "byte skip", "5");
  files.push_back(folder.file("skip.nrrd", textOf(lines) + zipped("12345" + counting(24))));
  set(lines, "byte skip", "-1");
  set(lines, "encoding", "raw");
  files.push_back(folder.file("end.nrrd", textOf(lines) + "passed over" + counting(24)));
  set(lines, "byte skip", "-");
  set(lines, "line skip", "2");
  files.push_back(folder.file("lines.nrrd", textOf(lines) + "one\ntwo\n" + counting(24)));
  set(lines, "line skip", "-");
  set(lines, "endian", "big");
  files.push_back(folder.file("big.nrrd", textOf(lines) + counting(24, true)));
  set(lines, "endian", "-");
  set(lines, "encoding", "ascii");
  std::string words;
  for (int i = 0; i < 24; ++i) words += std::to_string(i) + (i % 4 == 3 ? "\n" : " ");
  files.push_back(folder.file("text.nrrd", textOf(lines) + words));
  lines = plainHeader();
  set(lines, "data file", "voxels.raw");
  (void)folder.file("voxels.raw", counting(24));
  files.push_back(folder.file("detached.nhdr", textOf(lines)));
  std::string crlf = textOf(plainHeader());
  for (std::size_t at = 0; (at = crlf.find('\n', at)) != std::string::npos; at += 2) {
    crlf.insert(at, "\r");
  }
  files.push_back(folder.file("crlf.nrrd", crlf + counting(24)));
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const Image image = readImage(file);
    EXPECT_EQ(image.size, (std::array{4, 3, 2}));
    expectCounting(image);
    EXPECT_EQ(readImageInfo(file).data_type, "int16");
    EXPECT_LT(apartMm(image.toWorld({1, 1, 1}), Vec3(-11, -22, 33) * 1e-3), 1e-9);
  }
}

TEST(Nrrd, SpacesUnitsShearsAndMirrorsKeepTheirPlace) {
  struct Case {
    const char* space;
    const char* directions;
    const char* units;
    Vec3 expected_mm;  ///< place of voxel (1, 2, 1), RAS
    const char* orientation;
  };
  // Origin (10, 20, 30) + (1, 0.5, 0) + 2 (0, -2, 0.25) + (0.1, 0, 3) = (11.1, 16.5, 33.5).
  const char* sheared = "(1,0.5,0) (0,-2,0.25) (0.1,0,3)";
  const std::vector<Case> cases = {
      {"right-anterior-superior", sheared, "-", {11.1, 16.5, 33.5}, "RPS"},
      {"RAS", sheared, "\"mm\" \"mm\" \"mm\"", {11.1, 16.5, 33.5}, "RPS"},
      {"left-posterior-superior", sheared, "-", {-11.1, -16.5, 33.5}, "LAS"},
      {"LAS", sheared, "-", {-11.1, 16.5, 33.5}, "LPS"},
      {"LPS", sheared, "\"m\" \"m\" \"m\"", {-11100, -16500, 33500}, "LAS"},
      {"LPS", sheared, "\"um\" \"um\" \"um\"", {-0.0111, -0.0165, 0.0335}, "LAS"},
  };
  const TempFolder folder;
  for (const Case& c : cases) {
    Lines lines = plainHeader();
    set(lines, "space", c.space);
    set(lines, "space directions", c.directions);
    set(lines, "space units", c.units);
    const Image image = readImage(folder.file("a.nrrd", textOf(lines) + counting(24)));
    // Decimal numbers converted to doubles.
    EXPECT_LT(apartMm(image.toWorld({1, 2, 1}), c.expected_mm * 1e-3), 1e-4 * 1e-3) << c.space;
    EXPECT_EQ(readImageInfo(image.source).orientation, c.orientation) << c.space;
  }
}

TEST(Nrrd, WhatTheHeaderLeavesOpenIsAskedFor) {
  const TempFolder folder;
  Lines lines = plainHeader();
  set(lines, "space", "-");
  set(lines, "space directions", "-");
  set(lines, "space origin", "-");
  set(lines, "spacings", "1 2 3");
  const std::string bare = folder.file("bare.nrrd", textOf(lines) + counting(24));
  const Problem asked = errorOf([&] { (void)readImage(bare); }).problem();
  EXPECT_EQ(asked.code, "nrrd.no_affine");
  EXPECT_NE(asked.hint.find("--affine spacing"), std::string::npos);
  ImageOptions options;
  options.affine = AffineChoice::kSpacing;
  EXPECT_LT(apartMm(readImage(bare, options).toWorld({1, 1, 1}), Vec3(1, 2, 3) * 1e-3), 1e-9);

  lines = plainHeader();
  set(lines, "space", "3D-right-handed");
  const std::string odd = folder.file("odd.nrrd", textOf(lines) + counting(24));
  EXPECT_EQ(errorOf([&] { (void)readImage(odd); }).problem().code, "nrrd.space");
  options = {};
  options.space = Space::kLps;
  EXPECT_LT(apartMm(readImage(odd, options).toWorld({1, 1, 1}), Vec3(-11, -22, 33) * 1e-3), 1e-9);
  options.space = Space::kRas;
  EXPECT_LT(apartMm(readImage(odd, options).toWorld({1, 1, 1}), Vec3(11, 22, 33) * 1e-3), 1e-9);
  // A statement in the file is not overruled.
  const std::string said = folder.file("said.nrrd", textOf(plainHeader()) + counting(24));
  EXPECT_LT(apartMm(readImage(said, options).origin, Vec3(-10, -20, 30) * 1e-3), 1e-9);

  lines = plainHeader();
  set(lines, "space origin", "-");
  const Image image = readImage(folder.file("origin.nrrd", textOf(lines) + counting(24)));
  ASSERT_EQ(image.notes.size(), 1U);
  EXPECT_NE(image.notes[0].find("no space origin"), std::string::npos);
  // An option that a format does not use is a mistake.
  options = {};
  options.affine = AffineChoice::kQform;
  EXPECT_EQ(errorOf([&] { (void)readImage(said, options); }).problem().code, "image.option");
  options = {};
  options.series = "1";
  EXPECT_EQ(errorOf([&] { (void)readImageInfo(said, options); }).problem().code, "image.option");
}

TEST(Nrrd, OfFourDimensionsAFrameIsChosenWhereverTheAxisStands) {
  const TempFolder folder;
  for (const bool first : {true, false}) {
    Lines lines = plainHeader();
    set(lines, "dimension", "4");
    set(lines, "sizes", first ? "2 4 3 2" : "4 3 2 2");
    const std::string in_space = "(1,0,0) (0,2,0) (0,0,3)";
    set(lines, "space directions", first ? "none " + in_space : in_space + " none");
    set(lines, "kinds", first ? "list domain domain domain" : "domain domain domain time");
    std::string bytes;
    for (int i = 0; i < 48; ++i) {
      const int value = first ? i / 2 + 100 * (i % 2) : i % 24 + 100 * (i / 24);
      bytes += static_cast<char>(value);
      bytes += '\0';
    }
    const std::string file = folder.file("4d.nrrd", textOf(lines) + bytes);
    const Problem problem = errorOf([&] { (void)readImage(file); }).problem();
    EXPECT_EQ(problem.code, "nrrd.dimensions");
    EXPECT_NE(problem.hint.find("--frame 0"), std::string::npos);
    ImageOptions options;
    options.frame = 0;
    expectCounting(readImage(file, options));
    options.frame = 1;
    EXPECT_EQ(readImage(file, options).at(1, 2, 1), 100.0F + 21.0F);
    EXPECT_LT(apartMm(readImage(file, options).toWorld({1, 1, 1}), Vec3(-11, -22, 33) * 1e-3),
              1e-9);
    options.frame = 2;
    EXPECT_EQ(errorOf([&] { (void)readImage(file, options); }).problem().code, "nrrd.frame");
  }
}

struct BadHeader {
  const char* name;
  const char* code;
  const char* says;
  std::function<void(Lines&)> spoil;
};

class NrrdErrors : public ::testing::TestWithParam<BadHeader> {};

TEST_P(NrrdErrors, AreToldByFileAndByReaderAndInfoAlike) {
  const TempFolder folder;
  Lines lines = plainHeader();
  GetParam().spoil(lines);
  const std::string file = folder.file("bad.nrrd", textOf(lines) + counting(24));
  for (const bool header_only : {false, true}) {
    const Error error = errorOf([&] {
      if (header_only) {
        (void)readImageInfo(file);
      } else {
        (void)readImage(file);
      }
    });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problem().code, GetParam().code) << error.what();
    EXPECT_EQ(error.problem().file, file);
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, NrrdErrors,
    ::testing::Values(
        BadHeader{"Type", "nrrd.data_type", "block", [](Lines& l) { set(l, "type", "block"); }},
        BadHeader{"NoType", "nrrd.field", "'type'", [](Lines& l) { set(l, "type", "-"); }},
        BadHeader{"Twice", "nrrd.field", "given twice",
                  [](Lines& l) { l.emplace_back("sizes", "4 3 2"); }},
        BadHeader{"NoColon", "nrrd.field", "not a line of a NRRD header",
                  [](Lines& l) { l.emplace_back("kinds domain", " "); }},
        BadHeader{"Flat", "nrrd.dimensions", "4 x 3 x 1",
                  [](Lines& l) { set(l, "sizes", "4 3 1"); }},
        BadHeader{"Sizes", "nrrd.dimensions", "3 dimensions",
                  [](Lines& l) { set(l, "sizes", "4 3"); }},
        BadHeader{"NegativeSize", "nrrd.dimensions", "-3",
                  [](Lines& l) { set(l, "sizes", "4 -3 2"); }},
        BadHeader{"Color", "nrrd.data_type", "rgb-color",
                  [](Lines& l) {
                    set(l, "dimension", "4");
                    set(l, "sizes", "3 2 2 2");
                    set(l, "kinds", "RGB-color domain domain domain");
                    set(l, "space directions", "none (1,0,0) (0,2,0) (0,0,3)");
                  }},
        BadHeader{"FourInSpace", "nrrd.dimensions", "4 of the 4 axes (3 x 2 x 2 x 2) lie in space",
                  [](Lines& l) {
                    set(l, "dimension", "4");
                    set(l, "sizes", "3 2 2 2");
                    set(l, "kinds", "-");
                    set(l, "space directions", "-");
                  }},
        BadHeader{"Encoding", "nrrd.encoding", "bzip2",
                  [](Lines& l) { set(l, "encoding", "bzip2"); }},
        BadHeader{"NoEndian", "nrrd.endian", "byte order", [](Lines& l) { set(l, "endian", "-"); }},
        BadHeader{"Singular", "nrrd.singular", "no volume",
                  [](Lines& l) { set(l, "space directions", "(1,0,0) (0,2,0) (1,2,0)"); }},
        BadHeader{"Infinite", "nrrd.singular", "no volume",
                  [](Lines& l) { set(l, "space directions", "(1,0,0) (0,inf,0) (0,0,1)"); }},
        BadHeader{"ShortVector", "nrrd.directions", "three numbers",
                  [](Lines& l) { set(l, "space directions", "(1,0) (0,2,0) (0,0,1)"); }},
        BadHeader{"BothSpacings", "nrrd.directions", "only one of them",
                  [](Lines& l) { set(l, "spacings", "1 2 3"); }},
        BadHeader{"Unit", "nrrd.unit", "furlong",
                  [](Lines& l) { set(l, "space units", "\"furlong\" \"furlong\" \"furlong\""); }},
        BadHeader{"TwoUnits", "nrrd.unit", "different",
                  [](Lines& l) { set(l, "space units", "\"mm\" \"mm\" \"m\""); }},
        BadHeader{"Origin", "nrrd.origin", "three numbers",
                  [](Lines& l) { set(l, "space origin", "(1,2)"); }},
        BadHeader{"SeveralFiles", "nrrd.data_files", "several files",
                  [](Lines& l) { set(l, "data file", "slice%03d.raw 1 2 1"); }},
        BadHeader{"NoDataFile", "nrrd.missing", "gone.raw",
                  [](Lines& l) { set(l, "data file", "gone.raw"); }},
        BadHeader{"TooShort", "nrrd.truncated", "asks for 96",
                  [](Lines& l) { set(l, "sizes", "4 3 4"); }},
        BadHeader{"Huge", "nrrd.truncated", "cut short",
                  [](Lines& l) { set(l, "sizes", "30000 30000 30000"); }}),
    [](const auto& c) { return std::string(c.param.name); });

TEST(NrrdCut, AnywhereIsRefused) {
  const TempFolder folder;
  for (const bool gzip : {false, true}) {
    Lines lines = plainHeader();
    if (gzip) set(lines, "encoding", "gzip");
    const std::string header = textOf(lines);
    const std::string whole = header + (gzip ? zipped(counting(24)) : counting(24));
    for (std::size_t length = 1; length < whole.size(); ++length) {
      const std::string file = folder.file("cut.nrrd", whole.substr(0, length));
      EXPECT_THROW((void)readImage(file), Error) << length << " of " << whole.size();
    }
    if (!gzip) continue;
    // ITK accepts the data before the checksum, whatever the checksum is.
    for (std::size_t back = 1; back <= 8; ++back) {
      std::string bad = whole;
      bad[bad.size() - back] = static_cast<char>(bad[bad.size() - back] ^ 0x40);
      const std::string file = folder.file("crc.nrrd", bad);
      EXPECT_EQ(errorOf([&] { (void)readImage(file); }).problem().code, "nrrd.checksum");
    }
  }
  // If there are more voxels than the header states, the header is wrong.
  Lines lines = plainHeader();
  set(lines, "encoding", "gzip");
  const std::string more = folder.file("more.nrrd", textOf(lines) + zipped(counting(30)));
  EXPECT_EQ(errorOf([&] { (void)readImage(more); }).problem().code, "nrrd.size");
}

/// Two interleaved layers of 4 x 3 x 2 bytes.
std::string layers(const std::array<int, 24>& first, const std::array<int, 24>& second) {
  std::string bytes;
  for (std::size_t i = 0; i < 24; ++i) {
    bytes += static_cast<char>(first[i]);
    bytes += static_cast<char>(second[i]);
  }
  return bytes;
}

Lines segmentHeader() {
  Lines lines = plainHeader();
  set(lines, "type", "unsigned char");
  set(lines, "dimension", "4");
  set(lines, "sizes", "2 4 3 2");
  set(lines, "space directions", "none (1,0,0) (0,2,0) (0,0,3)");
  set(lines, "kinds", "list domain domain domain");
  set(lines, "Segment0_Name", "late");
  set(lines, "Segment0_LabelValue", "1");
  set(lines, "Segment0_Layer", "1");
  set(lines, "Segment1_Name", "early");
  set(lines, "Segment1_LabelValue", "1");
  set(lines, "Segment1_Layer", "0");
  set(lines, "Segment1_Color", "0.5 0 1");
  return lines;
}

// Voxels in two segments go to the later segment of the file, not to the later layer.
TEST(NrrdSegments, TheLaterOfTheFileHasWhatTwoShare) {
  const TempFolder folder;
  std::array<int, 24> first{}, second{};
  first[3] = first[4] = 1;
  second[4] = second[5] = 1;
  const Image image =
      readImage(folder.file("s.seg.nrrd", textOf(segmentHeader()) + layers(first, second)));
  EXPECT_EQ(image.labels.names, (NameTable{{1, "late"}, {2, "early"}}));
  EXPECT_EQ(image.labels.colors, (std::map<int, LabelColor>{{2, {0.5F, 0.0F, 1.0F}}}));
  EXPECT_EQ(image.values[3], 2.0F);
  EXPECT_EQ(image.values[4], 2.0F);
  EXPECT_EQ(image.values[5], 1.0F);
  EXPECT_EQ(std::count(image.values.begin(), image.values.end(), 0.0F), 21);
}

TEST(NrrdSegments, FilesBeforeSharedLayersHaveOneEach) {
  const TempFolder folder;
  Lines lines = segmentHeader();
  for (const char* key :
       {"Segment0_LabelValue", "Segment0_Layer", "Segment1_LabelValue", "Segment1_Layer"}) {
    set(lines, key, "-");
  }
  std::array<int, 24> first{}, second{};
  first[3] = 1;
  second[5] = 1;
  const Image image = readImage(folder.file("s.seg.nrrd", textOf(lines) + layers(first, second)));
  EXPECT_EQ(image.labels.names, (NameTable{{1, "late"}, {2, "early"}}));
  EXPECT_EQ(image.values[3], 1.0F);
  EXPECT_EQ(image.values[5], 2.0F);
}

TEST(NrrdSegments, WhatContradictsItselfIsRefused) {
  const TempFolder folder;
  std::array<int, 24> first{}, second{};
  first[23] = 1;  // voxel 3, 2, 1
  const auto code_of = [&](const std::function<void(Lines&)>& spoil) {
    Lines lines = segmentHeader();
    spoil(lines);
    const std::string file = folder.file("s.seg.nrrd", textOf(lines) + layers(first, second));
    return errorOf([&] { (void)readImage(file); }).problem().code;
  };
  EXPECT_EQ(code_of([](Lines& l) { set(l, "Segment1_Extent", "0 3 0 2 0 0"); }),
            "nrrd.segment_extent");
  EXPECT_EQ(code_of([](Lines& l) { set(l, "Segment1_Extent", "0 3 0 2"); }), "nrrd.segment");
  EXPECT_EQ(code_of([](Lines& l) { set(l, "Segment1_Layer", "2"); }), "nrrd.segment");
  EXPECT_EQ(code_of([](Lines& l) { set(l, "Segment0_Layer", "0"); }), "nrrd.segment");
  EXPECT_EQ(code_of([](Lines& l) { set(l, "Segment0_LabelValue", "x"); }), "nrrd.segment");
  EXPECT_EQ(code_of([](Lines& l) { set(l, "Segment1_Color", "2 0 0"); }), "nrrd.segment");
  EXPECT_EQ(code_of([](Lines& l) { set(l, "Segment1_LabelValue", "7"); }), "nrrd.segment");
  // Slicer saves an empty segmentation as a single voxel.
  EXPECT_EQ(code_of([](Lines& l) { set(l, "sizes", "2 1 1 1"); }), "nrrd.dimensions");
}

}  // namespace
}  // namespace palpate::vdb
