// The outputs that the command writes, and the files that it leaves alone.

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <thread>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

constexpr const char* kBall =
    "palpate: 1\nlength: mm\nlayers:\n  - {name: ball, inside: {sphere: {center: [0, 0, 0], "
    "radius: 20}}}\n";

class OutputFilesTest : public ::testing::Test {
 protected:
  OutputFilesTest() { (void)folder_.file("ball.yaml", kBall); }

  CommandResult touch(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"touch",    "ball.yaml", "--press", "0,0,20",
                                          "--normal", "0,0,1",     "--hold",  "0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runPalpate(arguments, folder_.path());
  }
  [[nodiscard]] struct stat statusOf(const std::string& name) const {
    struct stat status = {};
    EXPECT_EQ(stat(folder_.path(name).c_str(), &status), 0) << name;
    return status;
  }
  /// The trace as a plain file: every other kind of output must contain the same.
  std::string plainTrace() {
    EXPECT_EQ(touch({"--trace", "plain.csv"}).exit_code, 0);
    return textOf(folder_.path("plain.csv"));
  }
  static std::string withoutTimes(const std::string& trace) {
    std::string out;
    for (const std::string& line : linesOf(trace)) out += line.substr(0, line.rfind(',')) + "\n";
    return out;
  }

  TempFolder folder_;
};

TEST_F(OutputFilesTest, APipeIsWrittenAndStaysAPipe) {
  ASSERT_EQ(mkfifo(folder_.path("pipe").c_str(), 0600), 0);
  for (const bool force : {false, true}) {
    std::string got;
    std::thread reader([&] { got = textOf(folder_.path("pipe")); });
    const CommandResult result =
        touch(force ? std::vector<std::string>{"--trace", "pipe", "--force"}
                    : std::vector<std::string>{"--trace", "pipe"});
    // If the command did not open the pipe, its reader is still waiting.
    const int other_end = open(folder_.path("pipe").c_str(), O_WRONLY | O_NONBLOCK);
    if (other_end >= 0) close(other_end);
    reader.join();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(S_ISFIFO(statusOf("pipe").st_mode));
    EXPECT_EQ(withoutTimes(got), withoutTimes(plainTrace()));
    std::filesystem::remove(folder_.path("plain.csv"));
  }
}

TEST_F(OutputFilesTest, ADeviceIsWrittenAndStaysADevice) {
  // A separate device node: if it were replaced, the machine's own would be safe. Only root can
  // make one.
  std::string device = "/dev/full";
  if (mknod(folder_.path("null").c_str(), S_IFCHR | 0666, makedev(1, 3)) == 0) {
    EXPECT_EQ(touch({"--trace", "null", "--force"}).exit_code, 0);
    EXPECT_TRUE(S_ISCHR(statusOf("null").st_mode));
    ASSERT_EQ(mknod(folder_.path("full").c_str(), S_IFCHR | 0666, makedev(1, 7)), 0);
    device = "full";
  }
  const CommandResult full = touch({"--trace", device});
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_NE(full.err.find("cannot write"), std::string::npos) << full.err;
}

TEST_F(OutputFilesTest, AFileThatIsReplacedKeepsItsMode) {
  (void)folder_.file("t.csv", "old");
  ASSERT_EQ(chmod(folder_.path("t.csv").c_str(), 0640), 0);
  EXPECT_EQ(touch({"--trace", "t.csv"}).exit_code, 1);
  EXPECT_EQ(textOf(folder_.path("t.csv")), "old");
  ASSERT_EQ(touch({"--trace", "t.csv", "--force"}).exit_code, 0);
  EXPECT_EQ(statusOf("t.csv").st_mode & 07777U, 0640U);
  EXPECT_EQ(withoutTimes(textOf(folder_.path("t.csv"))), withoutTimes(plainTrace()));
  ASSERT_EQ(
      runPalpate({"bake", "ball.yaml", "-o", "b.vdb", "--voxel", "2"}, folder_.path()).exit_code,
      0);
  ASSERT_EQ(chmod(folder_.path("b.vdb").c_str(), 0600), 0);
  ASSERT_EQ(
      runPalpate({"bake", "ball.yaml", "-o", "b.vdb", "--voxel", "2", "--force"}, folder_.path())
          .exit_code,
      0);
  EXPECT_EQ(statusOf("b.vdb").st_mode & 07777U, 0600U);
}

TEST_F(OutputFilesTest, ALinkStaysAndLeadsToWhatIsNew) {
  const std::string there = folder_.path("there");
  ASSERT_EQ(mkdir(there.c_str(), 0700), 0);
  (void)folder_.file("there/real.csv", "old");
  ASSERT_EQ(symlink("there/real.csv", folder_.path("t.csv").c_str()), 0);
  EXPECT_EQ(touch({"--trace", "t.csv"}).exit_code, 1);
  EXPECT_EQ(textOf(there + "/real.csv"), "old");
  ASSERT_EQ(touch({"--trace", "t.csv", "--force"}).exit_code, 0);
  struct stat link = {};
  ASSERT_EQ(lstat(folder_.path("t.csv").c_str(), &link), 0);
  EXPECT_TRUE(S_ISLNK(link.st_mode));
  EXPECT_EQ(withoutTimes(textOf(there + "/real.csv")), withoutTimes(plainTrace()));
  EXPECT_EQ(filesIn(there).size(), 1U);
}

TEST_F(OutputFilesTest, ANewFileHasTheModeThatTheMaskLeaves) {
  ASSERT_EQ(touch({"--trace", "t.csv"}).exit_code, 0);
  const mode_t mask = umask(0);
  umask(mask);
  EXPECT_EQ(statusOf("t.csv").st_mode & 07777U, 0666U & ~mask);
}

TEST_F(OutputFilesTest, WhatCanBeForeseenIsNotFollowed) {
  // If the name of the temporary file were known, a link with that name could redirect the write.
  (void)folder_.file("victim", "untouched");
  bool saw = false;
  const CommandResult result = runPalpate(
      {"touch", "ball.yaml", "--press", "0,0,20", "--normal", "0,0,1", "--hold", "3", "--realtime",
       "--trace", "t.csv"},
      folder_.path(), [&](std::string_view, pid_t process) {
        if (saw) return;
        saw = true;
        const std::string foreseen = folder_.path("t.csv." + std::to_string(process) + ".tmp");
        EXPECT_EQ(symlink(folder_.path("victim").c_str(), foreseen.c_str()), 0);
        // Meanwhile the temporary file exists under another name, and belongs to this user only.
        int others = 0;
        for (const std::string& name : filesIn(folder_.path())) {
          others += name.starts_with("t.csv.") && name.ends_with(".tmp") ? 1 : 0;
        }
        EXPECT_EQ(others, 2);
      });
  EXPECT_TRUE(saw);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(textOf(folder_.path("victim")), "untouched");
  EXPECT_NE(textOf(folder_.path("t.csv")), "untouched");
}

TEST_F(OutputFilesTest, StandardOutputTakesATraceAndNothingElse) {
  const CommandResult result = touch({"--trace", "-"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(withoutTimes(result.out), withoutTimes(plainTrace()));
  EXPECT_NE(result.err.find("orce"), std::string::npos)
      << "the summary is talk then: " << result.err;
  const CommandResult both = touch({"--trace", "-", "--json"});
  EXPECT_EQ(both.exit_code, 2);
  const CommandResult grid = runPalpate({"convert", "ball.yaml", "-o", "-"}, folder_.path());
  EXPECT_EQ(grid.exit_code, 2) << grid.err;
}

TEST_F(OutputFilesTest, StandardInputGivesPointsAndPaths) {
  // The command runs without a terminal and with empty input, so that the answer is that of an
  // empty path.
  const CommandResult result = runPalpate({"touch", "ball.yaml", "--path", "-"}, folder_.path());
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("empty"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("stdin"), std::string::npos) << result.err;
}

TEST_F(OutputFilesTest, NothingIsLeftBehind) {
  ASSERT_EQ(touch({"--trace", "t.csv"}).exit_code, 0);
  EXPECT_EQ(filesIn(folder_.path()), (std::vector<std::string>{"ball.yaml", "t.csv"}));
  EXPECT_NE(touch({"--trace", "u.csv", "--path", "missing.csv"}).exit_code, 0);
  EXPECT_EQ(filesIn(folder_.path()), (std::vector<std::string>{"ball.yaml", "t.csv"}));
}

}  // namespace
}  // namespace palpate::testing
