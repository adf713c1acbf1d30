// MetaImage files made by hand: places, encodings, and files that are refused.
#include <gtest/gtest.h>
#include <zlib.h>

#include <functional>

#include "palpate/vdb/image.h"
#include "support/error_of.h"
#include "support/temp_file.h"
#include "vdb/header_lines.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;
using test::apartMm;
using test::counting;
using test::Lines;
using test::set;

Lines plainHeader() {
  return {{"ObjectType", "Image"},     {"NDims", "3"},
          {"BinaryData", "True"},      {"BinaryDataByteOrderMSB", "False"},
          {"CompressedData", "False"}, {"TransformMatrix", "1 0 0 0 1 0 0 0 1"},
          {"Offset", "10 20 30"},      {"ElementSpacing", "1 2 3"},
          {"DimSize", "4 3 2"},        {"ElementType", "MET_SHORT"}};
}

std::string textOf(const Lines& lines, const std::string& data = "LOCAL") {
  std::string text;
  for (const auto& [key, value] : lines) {
    if (value != "-") text += key + " = " + value + "\n";
  }
  return text + "ElementDataFile = " + data + "\n";
}

std::string zipped(const std::string& content) {
  uLongf size = compressBound(content.size());
  std::string out(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(out.data()), &size,
                     reinterpret_cast<const Bytef*>(content.data()), content.size()),
            Z_OK);
  out.resize(size);
  return out;
}

std::string codeOf(const std::string& file) {
  const Error error = errorOf([&] { (void)readImage(file); });
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.problem().file, file);
  return error.problem().code;
}

TEST(MetaImage, EveryEncodingGivesTheSameVoxels) {
  const TempFolder folder;
  Lines lines = plainHeader();
  std::vector<std::string> files = {folder.file("raw.mha", textOf(lines) + counting(24))};
  set(lines, "BinaryDataByteOrderMSB", "True");
  files.push_back(folder.file("big.mha", textOf(lines) + counting(24, true)));
  set(lines, "BinaryDataByteOrderMSB", "False");
  set(lines, "CompressedData", "True");
  files.push_back(folder.file("unsized.mha", textOf(lines) + zipped(counting(24))));
  set(lines, "CompressedDataSize", std::to_string(zipped(counting(24)).size()));
  files.push_back(folder.file("sized.mha", textOf(lines) + zipped(counting(24))));
  (void)folder.file("voxels.zraw", zipped(counting(24)));
  files.push_back(folder.file("detached.mhd", textOf(lines, "voxels.zraw")));
  set(lines, "CompressedData", "-");
  set(lines, "CompressedDataSize", "-");
  set(lines, "HeaderSize", "-1");
  (void)folder.file("voxels.raw", "something before" + counting(24));
  files.push_back(folder.file("end.mhd", textOf(lines, "voxels.raw")));
  set(lines, "HeaderSize", "16");
  files.push_back(folder.file("skip.mhd", textOf(lines, "voxels.raw")));
  set(lines, "HeaderSize", "-");
  set(lines, "BinaryData", "False");
  std::string words;
  for (int i = 0; i < 24; ++i) words += std::to_string(i) + " ";
  files.push_back(folder.file("text.mha", textOf(lines) + words));
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const Image image = readImage(file);
    EXPECT_EQ(image.size, (std::array{4, 3, 2}));
    for (std::size_t i = 0; i < 24; ++i) ASSERT_EQ(image.values[i], static_cast<float>(i));
    EXPECT_LT(apartMm(image.toWorld({1, 1, 1}), Vec3(-11, -22, 33) * 1e-3), 1e-9);
    EXPECT_EQ(readImageInfo(file).orientation, "LPS");
    EXPECT_TRUE(image.notes.empty());
  }
}

TEST(MetaImage, RowsOfTheMatrixAreTheAxes) {
  const TempFolder folder;
  Lines lines = plainHeader();
  // i runs along +y, j along -x, k is mirrored and sheared.
  set(lines, "TransformMatrix", "0 1 0 -1 0 0 0.1 0 -1");
  const Image image = readImage(folder.file("a.mha", textOf(lines) + counting(24)));
  // (10, 20, 30) + 1 (0, 1, 0) + 2 * 2 (-1, 0, 0) + 1 * 3 (0.1, 0, -1) = (6.3, 21, 27), LPS.
  EXPECT_LT(apartMm(image.toWorld({1, 2, 1}), Vec3(-6.3, -21, 27) * 1e-3), 1e-9);
  EXPECT_EQ(readImageInfo(image.source).orientation, "PRI");
  // Left-handed: the determinant of (0,-1,0), (2,0,0), (-0.3,0,-3) is negative.
  EXPECT_LT(glm::determinant(image.axes), 0.0);
}

TEST(MetaImage, WhatIsNotSaidOrSaidTwiceIsTold) {
  const TempFolder folder;
  Lines lines = plainHeader();
  set(lines, "AnatomicalOrientation", "RAI");
  EXPECT_TRUE(readImage(folder.file("a.mha", textOf(lines) + counting(24))).notes.empty());
  set(lines, "AnatomicalOrientation", "LPI");
  set(lines, "Offset", "-");
  set(lines, "ElementToIntensityFunctionSlope", "2");
  set(lines, "ElementToIntensityFunctionOffset", "-5");
  const Image image = readImage(folder.file("b.mha", textOf(lines) + counting(24)));
  ASSERT_EQ(image.notes.size(), 3U);
  EXPECT_NE(image.notes[0].find("no Offset"), std::string::npos);
  EXPECT_NE(image.notes[1].find("run to RAS, the matrix to LPS"), std::string::npos)
      << image.notes[1];
  EXPECT_EQ(image.values[3], 1.0F);
}

TEST(MetaImage, OfFourDimensionsAFrameIsChosen) {
  const TempFolder folder;
  Lines lines = plainHeader();
  set(lines, "NDims", "4");
  set(lines, "DimSize", "4 3 2 2");
  set(lines, "Offset", "10 20 30 0");
  set(lines, "ElementSpacing", "1 2 3 1");
  set(lines, "TransformMatrix", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  for (const bool packed : {false, true}) {
    set(lines, "CompressedData", packed ? "True" : "False");
    const std::string file =
        folder.file("a.mha", textOf(lines) + (packed ? zipped(counting(48)) : counting(48)));
    EXPECT_EQ(codeOf(file), "metaimage.dimensions");
    ImageOptions options;
    for (int frame = 0; frame < 2; ++frame) {
      options.frame = frame;
      const Image image = readImage(file, options);
      EXPECT_EQ(image.values[5], static_cast<float>(24 * frame + 5));
      EXPECT_LT(apartMm(image.toWorld({1, 1, 1}), Vec3(-11, -22, 33) * 1e-3), 1e-9);
    }
    options.frame = 2;
    EXPECT_EQ(errorOf([&] { (void)readImage(file, options); }).problem().code, "metaimage.frame");
  }
}

struct BadHeader {
  const char* name;
  const char* code;
  std::function<void(Lines&)> spoil;
};

class MetaImageErrors : public ::testing::TestWithParam<BadHeader> {};

TEST_P(MetaImageErrors, AreNamed) {
  const TempFolder folder;
  Lines lines = plainHeader();
  GetParam().spoil(lines);
  const std::string file = folder.file("bad.mha", textOf(lines) + counting(24));
  EXPECT_EQ(codeOf(file), GetParam().code);
  EXPECT_THROW((void)readImageInfo(file), Error);
}

INSTANTIATE_TEST_SUITE_P(
    All, MetaImageErrors,
    ::testing::Values(
        BadHeader{"Type", "metaimage.data_type",
                  [](Lines& l) { set(l, "ElementType", "MET_STRING"); }},
        BadHeader{"Channels", "metaimage.data_type",
                  [](Lines& l) { set(l, "ElementNumberOfChannels", "3"); }},
        BadHeader{"Object", "metaimage.format", [](Lines& l) { set(l, "ObjectType", "Mesh"); }},
        BadHeader{"Flat", "metaimage.dimensions", [](Lines& l) { set(l, "DimSize", "4 3 1"); }},
        BadHeader{"Sizes", "metaimage.dimensions", [](Lines& l) { set(l, "DimSize", "4 3"); }},
        BadHeader{"Spacing", "metaimage.spacing",
                  [](Lines& l) { set(l, "ElementSpacing", "1 -2 3"); }},
        BadHeader{"NoSpacing", "metaimage.spacing",
                  [](Lines& l) { set(l, "ElementSpacing", "-"); }},
        BadHeader{"Singular", "metaimage.singular",
                  [](Lines& l) { set(l, "TransformMatrix", "1 0 0 0 1 0 1 1 0"); }},
        BadHeader{"ShortMatrix", "metaimage.matrix",
                  [](Lines& l) { set(l, "TransformMatrix", "1 0 0 0 1 0"); }},
        BadHeader{"NotANumber", "metaimage.offset",
                  [](Lines& l) { set(l, "Offset", "1 2 three"); }},
        BadHeader{"Flag", "metaimage.field", [](Lines& l) { set(l, "CompressedData", "maybe"); }},
        BadHeader{"Twice", "metaimage.field", [](Lines& l) { l.emplace_back("DimSize", "4 3 2"); }},
        BadHeader{"TooShort", "metaimage.truncated", [](Lines& l) { set(l, "DimSize", "4 3 3"); }}),
    [](const auto& c) { return std::string(c.param.name); });

TEST(MetaImageCut, WrongSizesAndChecksumsAreRefused) {
  const TempFolder folder;
  Lines lines = plainHeader();
  set(lines, "CompressedData", "True");
  const std::string packed = zipped(counting(24));
  const auto with_size = [&](long size, const std::string& data) {
    set(lines, "CompressedDataSize", std::to_string(size));
    return folder.file("z.mha", textOf(lines) + data);
  };
  const long size = static_cast<long>(packed.size());
  EXPECT_EQ(codeOf(with_size(size + 1, packed)), "metaimage.truncated");
  EXPECT_EQ(codeOf(with_size(size - 1, packed)), "metaimage.compressed_size");
  EXPECT_EQ(codeOf(with_size(size - 1, packed.substr(0, packed.size() - 1))),
            "metaimage.truncated");
  std::string bad = packed;
  bad.back() = static_cast<char>(bad.back() ^ 1);
  EXPECT_EQ(codeOf(with_size(size, bad)), "metaimage.checksum");
  const std::string more = zipped(counting(30));
  EXPECT_EQ(codeOf(with_size(static_cast<long>(more.size()), more)), "metaimage.size");
  EXPECT_EQ(codeOf(folder.file("d.mhd", textOf(plainHeader(), "gone.raw"))), "metaimage.missing");
  EXPECT_EQ(codeOf(folder.file("l.mhd", textOf(plainHeader(), "LIST"))), "metaimage.data_files");
  EXPECT_EQ(codeOf(folder.file("t.mha", "ObjectType = Image\nNDims = 3\n")), "metaimage.truncated");
  EXPECT_EQ(codeOf(folder.file("n.mha", "no image at all")), "metaimage.format");
  const std::string whole = textOf(plainHeader()) + counting(24);
  for (std::size_t length = 1; length < whole.size(); ++length) {
    const std::string file = folder.file("cut.mha", whole.substr(0, length));
    EXPECT_THROW((void)readImage(file), Error) << length << " of " << whole.size();
  }
}

}  // namespace
}  // namespace palpate::vdb
