// Tables of label names, and the labels that a scene's `match` means.
#include <gtest/gtest.h>

#include <filesystem>

#include "palpate/core/error.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/scan_surface.h"
#include "support/scan_folder.h"
#include "vdb/nifti_writer.h"

namespace palpate::vdb {
namespace {

using test::writeTemporary;

const std::string kData = palpate::testing::scansFolder();

NameTable tableOf(const std::string& text) {
  return readLabelTable(writeTemporary("t.txt", text)).names;
}

void expectRefused(const std::string& text, const std::string& code, int line,
                   const std::string& says) {
  try {
    (void)tableOf(text);
    ADD_FAILURE() << "read without complaint: " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, code);
    EXPECT_EQ(error.problem().line, line) << error.what();
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
  }
}

TEST(NameTable, ReadsMricronsAal) {
  const NameTable names = readLabelTable("/usr/share/mricron/templates/aal.nii.txt").names;
  EXPECT_EQ(names.size(), 116U);
  EXPECT_EQ(names.at(1), "Precentral_L");
  EXPECT_EQ(names.at(77), "Thalamus_L");
  EXPECT_EQ(names.at(78), "Thalamus_R");
}

TEST(NameTable, ReadsTheAbdomensCsv) {
  const std::string path = palpate::testing::scanPath("abdomen/labels.csv");
  PALPATE_NEEDS_SCAN(path);
  const NameTable names = readLabelTable(path).names;
  EXPECT_EQ(names.at(0), "background");
  EXPECT_EQ(names.at(5), "liver");
}

TEST(NameTable, ReadsBothShapesWithCommentsBlankLinesBomAndCrLf) {
  const NameTable expected = {{-1, "other"}, {2, "Caudate_L"}, {30, "skin"}};
  EXPECT_EQ(tableOf("2 Caudate_L 7001\n30 skin\n-1 other\n"), expected);
  EXPECT_EQ(tableOf("\xEF\xBB\xBF# a comment\r\n\r\n  2\tCaudate_L\r\n30\tskin\r\n -1 other"),
            expected);
  EXPECT_EQ(tableOf("value,name\r\n2,Caudate_L\r\n30 , skin\r\n-1,other,9,9\r\n"), expected);
  EXPECT_EQ(tableOf("2,Caudate_L\n30,skin\n-1,other\n"), expected);
  EXPECT_EQ(
      tableOf(
          "# Color table file\n2 Caudate_L 255 200 135 255\n30 skin 1 2 3 255\n-1 other 0 0 0 0"),
      expected);
  EXPECT_EQ(tableOf("1\tleft lobe\t7\n"), (NameTable{{1, "left lobe"}}));
  EXPECT_EQ(tableOf("1,\"lobe, \"\"left\"\"\"\n"), (NameTable{{1, "lobe, \"left\""}}));
  EXPECT_EQ(tableOf("1 a\n1 a\n"), (NameTable{{1, "a"}}));
}

TEST(NameTable, RefusesWhatItCannotBeSureOf) {
  expectRefused("1 a\n\n1 b\n", "labels.table_duplicate", 3, "`b` here and `a` before");
  expectRefused("1 a\nx b\n", "labels.table_row", 2, "`x` is not a label value");
  expectRefused("1.5 a\n", "labels.table_row", 1, "1.5");
  expectRefused("99999999999 a\n", "labels.table_row", 1, "99999999999");
  expectRefused("1 a\n2\n", "labels.table_row", 2, "label 2 has no name");
  expectRefused("value,name\nvalue,name\n", "labels.table_row", 2, "`value`");
  expectRefused("1 left lobe\n", "labels.table_row", 1, "`lobe`");
  // A quoted name in a column where ITK-SNAP has none.
  expectRefused("1 255 0 0 1 1 \"liver\"\n", "labels.table_row", 1, "\"liver\"");
  expectRefused("1 255 0 0 1 1 1 \"a\"\n2 255 0 0 1 1 b\n", "labels.table_row", 2, "ITK-SNAP");
  expectRefused("1 255 0 0 1 x 1 \"a\"\n", "labels.table_row", 1, "`x`");
  expectRefused("1 liver 300 0 0 255\n", "labels.table_color", 1, "300");
  expectRefused("# only this\n", "labels.table_empty", 0, "no label");
}

TEST(LabelTable, ColorsOfEveryKindOfTableAreKept) {
  const NameTable names = {{0, "Clear Label"}, {2, "left lobe"}};
  const std::map<int, LabelColor> colors = {{0, {0, 0, 0}}, {2, {1.0F, 0.2F, 0.4F}}};
  const std::vector<std::string> texts = {
      "################\n# ITK-SnAP Label Description File\n# IDX   -R-  -G-  -B-  -A--  VIS MSH  "
      "LABEL\n"
      "    0     0    0    0        0  0  0    \"Clear Label\"\n"
      "    2   255   51  102        1  1  1    \"left lobe\"\n",
      "LabelValue,Name,Color_R,Color_G,Color_B,Color_A,SegmentedProperty\n"
      "0,Clear Label,0,0,0,0,\n2,left lobe,255,51,102,255,SCT 1 Lobe\n",
      "#No. Label Name:   R   G   B   A\n0\tClear Label\t0\t0\t0\t0\n2\tleft "
      "lobe\t255\t51\t102\t0\n",
  };
  for (const std::string& text : texts) {
    const LabelTable table = readLabelTable(writeTemporary("t.txt", text));
    EXPECT_EQ(table.names, names) << text;
    EXPECT_EQ(table.colors, colors) << text;
  }
  // A code is not a color.
  EXPECT_TRUE(readLabelTable(writeTemporary("t.txt", "2 lobe 7001\n")).colors.empty());
}

TEST(LabelTable, TheHeadsColorsAreSlicers) {
  const std::string path = kData + "/head_neck/colors.ctbl";
  PALPATE_NEEDS_SCAN(path);
  const LabelTable table = readLabelTable(path);
  EXPECT_EQ(table.names.at(25), "mandible");
  EXPECT_EQ(table.colors.at(25), (LabelColor{220 / 255.0F, 225 / 255.0F, 105 / 255.0F}));
  EXPECT_EQ(table.names.size(), table.colors.size());
}

TEST(NameTable, TellsOfMissingFiles) {
  for (const std::string& path :
       {::testing::TempDir() + "/no_such_table.csv", ::testing::TempDir()}) {
    try {
      (void)readLabelTable(path).names;
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, "labels.table_missing");
      EXPECT_EQ(error.problem().file, path);
    }
  }
}

const NameTable kNames = {{0, "background"}, {3, "rib_left_1"},  {4, "rib_left_2"},
                          {5, "liver"},      {8, "rib_right_1"}, {9, "liver"}};

TEST(ResolveLabels, TakesValuesNamesAndGlobs) {
  const auto resolve = [](std::vector<std::string> match) {
    return resolveLabels(match, kNames, "labels.csv");
  };
  EXPECT_EQ(resolve({"12"}), (std::vector{12}));  // a value need not have a name
  EXPECT_EQ(resolve({"liver"}), (std::vector{5, 9}));
  EXPECT_EQ(resolve({"rib_*_1", "4", "rib_left_?"}), (std::vector{3, 4, 8}));
  EXPECT_EQ(resolve({"background"}), (std::vector{0}));
  EXPECT_EQ(resolve({"*"}), (std::vector{3, 4, 5, 8, 9}));  // all except the background
  EXPECT_EQ(resolveLabels({"7", "-2"}, {}, ""), (std::vector{-2, 7}));
}

TEST(ResolveLabels, NamesWhatMatchesNothing) {
  const auto problem_of = [](std::vector<std::string> match, const NameTable& names) {
    try {
      (void)resolveLabels(match, names, "labels.csv");
    } catch (const Error& error) {
      return error.problem();
    }
    return Problem{};
  };
  const Problem slip = problem_of({"5", "livr"}, kNames);
  EXPECT_EQ(slip.code, "labels.unknown");
  EXPECT_NE(slip.message.find("`livr`"), std::string::npos);
  EXPECT_NE(slip.hint.find("`liver`"), std::string::npos) << slip.hint;
  EXPECT_EQ(slip.file, "labels.csv");
  EXPECT_EQ(problem_of({"Liver"}, kNames).code, "labels.unknown");
  EXPECT_EQ(problem_of({"spine_*"}, kNames).code, "labels.unknown");
  EXPECT_EQ(problem_of({"liver"}, {}).code, "labels.no_names");
}

}  // namespace
}  // namespace palpate::vdb
