// What counts as a change of a scene's file, and of the files that it names.

#include "view/scene_watch.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <filesystem>

#include "helpers.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;
using testing::TempFolder;

/// Looks `count` times, and returns the last report.
std::optional<SceneSight> looks(SceneWatch& watch, int count) {
  std::optional<SceneSight> told;
  for (int i = 0; i < count; ++i) {
    if (auto now = watch.look()) told = std::move(now);
  }
  return told;
}
constexpr int kSettled = 2;

TEST(SceneWatch, WhatIsSavedIsReportedOnce) {
  const TempFolder folder;
  SceneWatch watch(folder.file("cup.yaml", "one"));
  EXPECT_EQ(watch.first().text, "one");
  EXPECT_FALSE(looks(watch, 10));
  (void)folder.file("cup.yaml", "two");
  EXPECT_FALSE(watch.look()) << "it may still be written";
  const auto told = watch.look();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->text, "two");
  EXPECT_FALSE(looks(watch, 10));
}

TEST(SceneWatch, AnEditorMaySaveByRenaming) {
  const TempFolder folder;
  SceneWatch watch(folder.file("cup.yaml", "one"));
  fs::rename(folder.file("cup.yaml.swp", "two"), folder.path("cup.yaml"));
  const auto told = looks(watch, kSettled);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->text, "two");
}

TEST(SceneWatch, HalfAFileIsNotReported) {
  const TempFolder folder;
  SceneWatch watch(folder.file("cup.yaml", "one"));
  (void)folder.file("cup.yaml", "");
  EXPECT_FALSE(watch.look());
  (void)folder.file("cup.yaml", "tw");
  EXPECT_FALSE(watch.look());
  (void)folder.file("cup.yaml", "two");
  EXPECT_FALSE(watch.look());
  const auto told = watch.look();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->text, "two");
}

TEST(SceneWatch, AFileThatIsGoneForAMomentIsNotGone) {
  const TempFolder folder;
  SceneWatch watch(folder.file("cup.yaml", "one"));
  fs::remove(folder.path("cup.yaml"));
  EXPECT_FALSE(looks(watch, SceneWatch::kGone - 1));
  (void)folder.file("cup.yaml", "one");
  EXPECT_FALSE(looks(watch, 10));
  fs::remove(folder.path("cup.yaml"));
  const auto gone = looks(watch, SceneWatch::kGone);
  ASSERT_TRUE(gone);
  EXPECT_FALSE(gone->text);
  EXPECT_FALSE(looks(watch, 10)) << "once";
  // The file comes back as it was, so the report equals the first look.
  (void)folder.file("cup.yaml", "one");
  const auto back = looks(watch, kSettled);
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, watch.first());
}

TEST(SceneWatch, AClockThatStandsStillHidesNothing) {
  const TempFolder folder;
  const std::string file = folder.file("cup.yaml", "one");
  const std::array<timespec, 2> times = {{{1'000'000'000, 0}, {1'000'000'000, 0}}};
  ASSERT_EQ(utimensat(AT_FDCWD, file.c_str(), times.data(), 0), 0);
  SceneWatch watch(file);
  (void)folder.file("cup.yaml", "two");  // of the same length
  ASSERT_EQ(utimensat(AT_FDCWD, file.c_str(), times.data(), 0), 0);
  const auto told = looks(watch, kSettled);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->text, "two");
}

constexpr const char* kNames = "a: {file: bone.stl}\nb: \"masks\"\nc: 1500 N/m\nd: 0.5\n";

TEST(SceneWatch, FilesThatAreNamedCount) {
  const TempFolder folder;
  fs::create_directory(folder.path("masks"));
  (void)folder.file("bone.stl", "bone");
  (void)folder.file("masks/liver.nii", "liver");
  SceneWatch watch(folder.file("cup.yaml", kNames));
  EXPECT_FALSE(looks(watch, 10));
  const auto changed = [&](const std::string& what) {
    const auto told = looks(watch, kSettled);
    ASSERT_TRUE(told) << what;
    EXPECT_EQ(told->text, kNames) << what;
    EXPECT_NE(*told, watch.first()) << what;
    EXPECT_FALSE(looks(watch, 10)) << what;
  };
  (void)folder.file("bone.stl", "a longer bone");
  changed("a file");
  (void)folder.file("masks/liver.nii", "a larger liver");
  changed("a file in a folder");
  (void)folder.file("masks/spleen.nii", "spleen");
  changed("one more in it");
  fs::remove(folder.path("bone.stl"));
  changed("one that goes");
  (void)folder.file("bone.stl", "bone");
  changed("one that comes back");
  (void)folder.file("other.stl", "nobody names it");
  EXPECT_FALSE(looks(watch, 10));
}

TEST(SceneWatch, ANewTextNamesOtherFiles) {
  const TempFolder folder;
  SceneWatch watch(folder.file("cup.yaml", "a: bone.stl"));
  (void)folder.file("cup.yaml", "a: skull.stl");
  ASSERT_TRUE(looks(watch, kSettled));
  (void)folder.file("skull.stl", "it was missing");
  ASSERT_TRUE(looks(watch, kSettled));
  (void)folder.file("bone.stl", "nobody names it any more");
  EXPECT_FALSE(looks(watch, 10));
  // A text that is not YAML is reported; the files that the text before named still count.
  (void)folder.file("cup.yaml", "a: [");
  ASSERT_TRUE(looks(watch, kSettled));
  (void)folder.file("skull.stl", "mended");
  EXPECT_TRUE(looks(watch, kSettled));
}

TEST(SceneWatch, APipeInItsPlaceIsNotWaitedFor) {
  const TempFolder folder;
  SceneWatch watch(folder.file("cup.yaml", "one"));
  fs::remove(folder.path("cup.yaml"));
  ASSERT_EQ(mkfifo(folder.path("cup.yaml").c_str(), 0600), 0);
  const auto gone = looks(watch, SceneWatch::kGone);
  ASSERT_TRUE(gone);
  EXPECT_FALSE(gone->text);
}

}  // namespace
}  // namespace palpate::tools
