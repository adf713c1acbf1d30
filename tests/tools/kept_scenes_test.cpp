// Scenes whose grids were kept by an earlier run of the command, by several at once, or by one that
// was killed.

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <thread>

#include "tools/kept_felt.h"

namespace palpate::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kGrids = 3;

std::size_t gridsIn(const std::string& cache) {
  const std::vector<std::string> names = filesIn(cache);
  return static_cast<std::size_t>(std::count_if(
      names.begin(), names.end(), [](const std::string& name) { return name.ends_with(".vdb"); }));
}

TEST(KeptScenes, TheSecondTouchOfAnImportedScanBakesNothingAndFeelsTheSame) {
  const TempFolder folder;
  importLimb(folder);
  const Felt without = feltIn(folder, "limb.yaml", "a.csv", {"--no-cache"});
  ASSERT_GT(without.ticks.size(), 100U) << without.result.err << without.result.out;
  EXPECT_EQ(without.made, kGrids);
  const CacheFolder cache(folder.path("cache"));
  const Felt nothing = feltIn(folder, "limb.yaml", "b.csv", {"--no-cache"});
  EXPECT_EQ(nothing.made, kGrids);
  EXPECT_FALSE(fs::exists(folder.path("cache"))) << "--no-cache keeps nothing";
  const Felt first = feltIn(folder, "limb.yaml", "b.csv");
  EXPECT_EQ(first.made, kGrids);
  EXPECT_EQ(gridsIn(folder.path("cache")), kGrids);
  const Felt second = feltIn(folder, "limb.yaml", "c.csv");
  EXPECT_EQ(second.made, 0U);
  EXPECT_EQ(second.kept, kGrids);
  EXPECT_EQ(without.ticks, first.ticks);
  EXPECT_EQ(first.ticks, second.ticks);
  // Other verbs use the same grids; so does a scene that was edited only in places on which no grid
  // depends.
  std::string text = textOf(folder.path("limb.yaml"));
  (void)folder.file("edited.yaml", text + "# A word more.\n");
  EXPECT_EQ(feltIn(folder, "edited.yaml", "d.csv").kept, kGrids);
  EXPECT_EQ(feltIn(folder, "limb.yaml", "d.csv", {"--no-cache"}).made, kGrids);
}

TEST(KeptScenes, AnEmptyNameMeansThatNothingIsKept) {
  const TempFolder folder;
  importLimb(folder, 2.5);
  // An empty value is not an absolute path, but takes precedence over XDG.
  setenv("PALPATE_CACHE", "", 1);
  setenv("XDG_CACHE_HOME", folder.path("xdg").c_str(), 1);
  EXPECT_EQ(feltIn(folder, "limb.yaml", "a.csv").made, kGrids);
  EXPECT_FALSE(fs::exists(folder.path("xdg")));
  unsetenv("PALPATE_CACHE");
  unsetenv("XDG_CACHE_HOME");
}

TEST(KeptScenes, OfTwentyAtOnceOneMakesEachGrid) {
  const TempFolder folder;
  importLimb(folder, 2.0);
  const Felt alone = feltIn(folder, "limb.yaml", "alone.csv");
  const CacheFolder cache(folder.path("cache"));
  constexpr std::size_t kProcesses = 20;
  std::vector<Felt> felt(kProcesses);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < kProcesses; ++i) {
    threads.emplace_back(
        [&, i] { felt[i] = feltIn(folder, "limb.yaml", "t" + std::to_string(i) + ".csv"); });
  }
  for (std::thread& thread : threads) thread.join();
  std::size_t made = 0;
  for (const Felt& each : felt) {
    EXPECT_EQ(each.result.exit_code, 0) << each.result.err << each.result.out;
    EXPECT_EQ(each.ticks, alone.ticks);
    EXPECT_EQ(each.made + each.kept, kGrids);
    made += each.made;
  }
  EXPECT_EQ(made, kGrids);
  EXPECT_EQ(gridsIn(folder.path("cache")), kGrids);
}

TEST(KeptScenes, WhoeverIsKilledLeavesNothingThatHarms) {
  const TempFolder folder;
  importLimb(folder, 1.0);
  const Felt alone = feltIn(folder, "limb.yaml", "alone.csv");
  const CacheFolder cache(folder.path("cache"));
  std::mt19937 random(5);
  int killings = 0;
  for (int i = 0; i < 8; ++i) {
    fs::remove_all(folder.path("cache"));
    // Kill the command some time after this many grids exist (at once if 0), while a grid is made
    // or written.
    const std::string grids = std::to_string(static_cast<std::size_t>(i) % kGrids);
    const std::string on = std::to_string(0.005 * static_cast<double>(random() % 6));
    const std::string killed =
        "cd '" + folder.path() + "' && ('" + test::buildFolder() +
        "/bin/palpate' touch limb.yaml --insert 60,0,30 12,-7,30 >killed.txt 2>&1 & "
        "pid=$!; while kill -0 $pid 2>/dev/null && "
        "[ $(ls cache 2>/dev/null | grep -c 'vdb$') -lt " +
        grids + " ]; do :; done; sleep " + on + "; kill -9 $pid && wait $pid) 2>/dev/null";
    // 128 + 9: it was still running when it was killed.
    if (WEXITSTATUS(std::system(killed.c_str())) == 137) ++killings;
    const Felt next = feltIn(folder, "limb.yaml", "next.csv");
    EXPECT_EQ(next.result.exit_code, 0) << next.result.err << next.result.out;
    EXPECT_EQ(next.ticks, alone.ticks);
    const Felt last = feltIn(folder, "limb.yaml", "last.csv");
    EXPECT_EQ(last.kept, kGrids);
    EXPECT_EQ(last.ticks, alone.ticks);
  }
  EXPECT_GE(killings, 4) << "most were over before they were killed";
}

TEST(KeptScenes, AFolderThatCannotBeIsNoError) {
  const TempFolder folder;
  importLimb(folder, 2.5);
  const Felt alone = feltIn(folder, "limb.yaml", "alone.csv");
  for (const char* name : {"/proc/palpate", "/dev/null", "/dev/full"}) {
    const CacheFolder cache(name);
    const Felt felt = feltIn(folder, "limb.yaml", "felt.csv");
    EXPECT_EQ(felt.result.exit_code, 0) << name << felt.result.err;
    EXPECT_EQ(felt.made, kGrids) << name;
    EXPECT_EQ(felt.ticks, alone.ticks) << name;
  }
}

}  // namespace
}  // namespace palpate::testing
