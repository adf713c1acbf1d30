#include "palpate/devices/path.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <random>

#include "palpate/core/error.h"
#include "support/temp_file.h"

namespace palpate::devices {
namespace {

using testing::TempFolder;

Path read(std::string_view text) {
  const TempFolder folder;
  return readPath(folder.file("path.csv", text)).points;
}

/// The error that readPath() throws for `text`.
Problem problemOf(std::string_view text) {
  const TempFolder folder;
  const std::string file = folder.file("path.csv", text);
  try {
    static_cast<void>(readPath(file));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problem().file, file);
    return error.problem();
  }
  ADD_FAILURE() << "was read: " << text;
  return {};
}

TEST(ReadPath, ReadsRowsInOrder) {
  const Path path = read("t,x,y,z\n0,1,2,3\n0.001,-1e-3,.5,4.\n");
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[0].t, 0.0);
  EXPECT_EQ(path[0].position, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(path[1].t, 0.001);
  EXPECT_EQ(path[1].position, Vec3(-0.001, 0.5, 4.0));
}

TEST(ReadPath, TheHeaderSaysInWhichFrameItIs) {
  const TempFolder folder;
  const RecordedPath world = readPath(folder.file("w.csv", "t,x,y,z\n0,1,2,3\n"));
  const RecordedPath device =
      readPath(folder.file("d.csv", "t,device_x,device_y,device_z\r\n0,1,2,3\r\n"));
  EXPECT_EQ(world.frame, DeviceFrame::kWorld);
  EXPECT_EQ(device.frame, DeviceFrame::kDevice);
  ASSERT_EQ(device.points.size(), 1U);
  EXPECT_EQ(device.points[0].position, Vec3(1.0, 2.0, 3.0));
}

TEST(ReadPath, AsRecordedItHoldsFaults) {
  const TempFolder folder;
  const std::string file =
      folder.file("f.csv", "t,x,y,z\n0.2,nan,2,3\n0.2,-inf,1e-3,3\n0.1,1,2,3\nnan,0,0,1\n");
  const Path path = readPath(file, PathRules::kAsRecorded).points;
  ASSERT_EQ(path.size(), 4U);
  EXPECT_TRUE(std::isnan(path[0].position.x));
  EXPECT_EQ(path[1].position.x, -kInfinity);
  EXPECT_EQ(path[1].t, path[0].t);
  EXPECT_EQ(path[2].t, 0.1);
  EXPECT_TRUE(std::isnan(path[3].t));
  // Text that is not a number at all is still refused.
  for (const char* row : {"0,x,1,2", "0,1,2", "0,1,2,3,4", "0,,1,2", "", "# 1", "0, 1,2,3"}) {
    const std::string bad = folder.file("b.csv", std::string("t,x,y,z\n") + row + "\n");
    EXPECT_THROW((void)readPath(bad, PathRules::kAsRecorded), Error) << row;
  }
  VirtualDevice device(path, DeviceFrame::kWorld, PathRules::kAsRecorded);
  device.open();
  for (const PathPoint& point : path) {
    DeviceState state;
    ASSERT_EQ(device.read(state), DeviceStatus::kOk);
    EXPECT_EQ(state.position.z, point.position.z);
    EXPECT_EQ(state.velocity, Vec3(0.0)) << "no time rises here";
  }
}

TEST(ReadPath, LineEndsMayBeCrlfAndTheLastMayBeMissing) {
  for (const char* text : {"t,x,y,z\r\n0,1,2,3\r\n1,4,5,6\r\n", "t,x,y,z\r\n0,1,2,3\r\n1,4,5,6",
                           "t,x,y,z\n0,1,2,3\n1,4,5,6", "t,x,y,z\n0,1,2,3\r\n1,4,5,6\r"}) {
    const Path path = read(text);
    ASSERT_EQ(path.size(), 2U) << text;
    EXPECT_EQ(path[1].position, Vec3(4.0, 5.0, 6.0)) << text;
  }
}

TEST(ReadPath, EveryNumberIsReadExactlyAndPiecesMeetWithoutASeam) {
  // About 4 MB of rows of varying length, so that the reader's pieces end anywhere in a row.
  std::mt19937_64 random(3);
  std::string text = "t,x,y,z\n";
  Path expected;
  for (int i = 0; i < 50000; ++i) {
    PathPoint point;
    point.t = 1e-3 * i;
    for (int k = 0; k < 3; ++k) {
      do {
        point.position[k] = std::bit_cast<double>(random());
      } while (!std::isfinite(point.position[k]));
    }
    expected.push_back(point);
    std::array<char, 32> digits{};
    const std::array<double, 4> row{point.t, point.position.x, point.position.y, point.position.z};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), row[k]).ptr;
      text.append(digits.data(), end);
      text += k < 3 ? ',' : '\n';
    }
  }
  const Path path = read(text);
  ASSERT_EQ(path.size(), expected.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint64_t>(path[i].t), std::bit_cast<std::uint64_t>(expected[i].t));
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(path[i].position[k]),
                std::bit_cast<std::uint64_t>(expected[i].position[k]));
    }
  }
}

struct BadFile {
  const char* name;
  const char* text;
  const char* code;
  int line;
  int column;
  const char* offending;  // must be in the message or the excerpt
};

class ReadPathRefuses : public ::testing::TestWithParam<BadFile> {};

TEST_P(ReadPathRefuses, WithPlaceAndText) {
  const BadFile& bad = GetParam();
  const Problem problem = problemOf(bad.text);
  EXPECT_EQ(problem.code, bad.code);
  EXPECT_EQ(problem.line, bad.line);
  EXPECT_EQ(problem.column, bad.column);
  EXPECT_NE((problem.message + problem.excerpt).find(bad.offending), std::string::npos)
      << formatProblem(problem);
}

INSTANTIATE_TEST_SUITE_P(
    Files, ReadPathRefuses,
    ::testing::Values(
        BadFile{"Empty", "", "path.empty", 0, 0, ""},
        BadFile{"HeaderAlone", "t,x,y,z\n", "path.empty", 0, 0, ""},
        BadFile{"NoHeader", "0,1,2,3\n", "path.header", 1, 1, "0,1,2,3"},
        BadFile{"SpacedHeader", "t, x, y, z\n0,1,2,3\n", "path.header", 1, 1, "t, x, y, z"},
        BadFile{"UpperHeader", "T,X,Y,Z\n0,1,2,3\n", "path.header", 1, 1, "T,X,Y,Z"},
        BadFile{"BlankHeader", "\nt,x,y,z\n", "path.header", 1, 1, ""},
        BadFile{"MixedHeader", "t,device_x,y,z\n0,1,2,3\n", "path.header", 1, 1, "device_x,y,z"},
        BadFile{"ByteOrderMark", "\xEF\xBB\xBFt,x,y,z\n0,1,2,3\n", "path.header", 1, 1, "mark"},
        BadFile{"Comment", "t,x,y,z\n0,1,2,3\n# end\n", "path.comment", 3, 1, "# end"},
        BadFile{"SlashComment", "t,x,y,z\n// 0,1,2,3\n", "path.comment", 2, 1, "// 0,1,2,3"},
        BadFile{"BlankLine", "t,x,y,z\n0,1,2,3\n\n1,1,2,3\n", "path.blank", 3, 1, ""},
        BadFile{"BlankEnd", "t,x,y,z\n0,1,2,3\n\n", "path.blank", 3, 1, ""},
        BadFile{"FewColumns", "t,x,y,z\n0,1,2\n", "path.columns", 2, 1, "0,1,2"},
        BadFile{"ManyColumns", "t,x,y,z\n0,1,2,3,4\n", "path.columns", 2, 1, "5 columns"},
        BadFile{"TrailingComma", "t,x,y,z\n0,1,2,3,\n", "path.columns", 2, 1, "5 columns"},
        BadFile{"Semicolons", "t,x,y,z\n0;1;2;3\n", "path.columns", 2, 1, "0;1;2;3"},
        BadFile{"DecimalComma", "t,x,y,z\n0,0,1,5,2,0\n", "path.columns", 2, 1, "6 columns"},
        BadFile{"Word", "t,x,y,z\n0,1,two,3\n", "path.number", 2, 5, "y = 'two'"},
        BadFile{"NoNumber", "t,x,y,z\n0,,2,3\n", "path.number", 2, 3, "x = ''"},
        BadFile{"Space", "t,x,y,z\n0, 1,2,3\n", "path.number", 2, 3, "x = ' 1'"},
        BadFile{"Plus", "t,x,y,z\n0,+1,2,3\n", "path.number", 2, 3, "x = '+1'"},
        BadFile{"Hex", "t,x,y,z\n0,0x10,2,3\n", "path.number", 2, 3, "x = '0x10'"},
        BadFile{"Unit", "t,x,y,z\n0,1,2,3mm\n", "path.number", 2, 7, "z = '3mm'"},
        BadFile{"Quote", "t,x,y,z\n0,\"1\",2,3\n", "path.number", 2, 3, "x = '\"1\"'"},
        BadFile{"NotANumber", "t,x,y,z\n0,1,nan,3\n", "path.not_finite", 2, 5, "y = 'nan'"},
        BadFile{"Infinite", "t,x,y,z\n0,1,2,-inf\n", "path.not_finite", 2, 7, "z = '-inf'"},
        BadFile{"TooLarge", "t,x,y,z\n0,1e999,2,3\n", "path.not_finite", 2, 3, "x = '1e999'"},
        BadFile{"SameTime", "t,x,y,z\n0,1,2,3\n0,1,2,3\n", "path.time", 3, 1, "t = '0'"},
        BadFile{"TimeBack", "t,x,y,z\n0,1,2,3\n1,1,2,3\n0.5,1,2,3\n", "path.time", 4, 1,
                "t = '0.5'"}),
    [](const ::testing::TestParamInfo<BadFile>& file) { return file.param.name; });

TEST(ReadPath, ABinaryFileIsRefusedInOneShortPrintableMessage) {
  std::string text = "t,x,y,z\n";
  text.resize(3U << 20U, '\0');
  const Problem problem = problemOf(text);
  EXPECT_EQ(problem.code, "path.columns");
  EXPECT_LT(problem.excerpt.size(), 200U);
  EXPECT_EQ(problem.excerpt.find('\0'), std::string::npos);
}

TEST(ReadPath, AMissingFileAndAFolderAreSaidToBeThat) {
  const TempFolder folder;
  for (const auto& [path, words] :
       {std::pair{folder.path("none.csv"), "no such file"}, std::pair{folder.path(), "folder"}}) {
    try {
      static_cast<void>(readPath(path));
      FAIL() << path << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_EQ(error.problem().code, "path.unreadable");
      EXPECT_NE(error.problem().message.find(words), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace palpate::devices
