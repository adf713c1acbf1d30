// The parts of the cache of grids: keys of content, seals, locks, the limit.
#include "keep/grid_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <list>
#include <random>
#include <set>
#include <thread>

#include "keep/content_key.h"
#include "keep/making_lock.h"
#include "keep/seal.h"
#include "keep/source_state.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/kept_grids.h"
#include "scene_image.h"
#include "support/temp_file.h"
#include "vdb/made_scans.h"

namespace palpate::vdb {
namespace {

namespace fs = std::filesystem;

LevelSet ball(double radius) {
  BakeOptions options;
  options.voxel_size = 1e-3;
  CertifyOptions certify;
  certify.is_foreign = false;
  return certified(bake(*sphere(Vec3(0.0), radius), options), certify).grid;
}

std::string keyOf(int n) { return ContentKey().add(n).text(); }

TEST(ContentKeys, DifferWhereContentDiffers) {
  std::set<std::string> keys;
  std::size_t count = 0;
  const auto add = [&](const ContentKey& key) {
    keys.insert(key.text());
    EXPECT_EQ(key.text().size(), 32U);
    ++count;
  };
  add(ContentKey());
  add(ContentKey().add(0));
  add(ContentKey().add(0).add(0));
  add(ContentKey().add(
      0.0));  // the same bits as the integer 0, hence the same key: keys begin with a kind
  --count;
  add(ContentKey().add(-0.0));
  add(ContentKey().add("ab").add("c"));
  add(ContentKey().add("a").add("bc"));
  std::mt19937 random(3);
  std::string bytes(1000, 'x');
  for (char& c : bytes) c = static_cast<char>(random());
  add(ContentKey().add(bytes));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string other = bytes;
    other[bit / 8] = static_cast<char>(other[bit / 8] ^ (1 << (bit % 8)));
    add(ContentKey().add(other));
  }
  EXPECT_EQ(keys.size(), count);
  // Each half of the key alone must differ, too: 64 bits, some thousand keys.
  std::set<std::string> first;
  std::set<std::string> second;
  for (const std::string& key : keys) {
    first.insert(key.substr(0, 16));
    second.insert(key.substr(16));
  }
  EXPECT_EQ(first.size(), count);
  EXPECT_EQ(second.size(), count);
}

TEST(ContentKeys, OfAFileAreOfAllItsBytes) {
  const palpate::testing::TempFolder folder;
  std::string bytes((std::size_t{1} << 20U) + 77, 'a');  // more than is read at a time
  const std::string path = folder.file("some", bytes);
  const auto key_of_file = [&] {
    ContentKey key;
    EXPECT_TRUE(key.addFile(path));
    return key.text();
  };
  const std::string whole = key_of_file();
  for (const std::size_t at : {std::size_t{0}, std::size_t{1} << 20U, bytes.size() - 1}) {
    std::string other = bytes;
    other[at] = 'b';
    (void)folder.file("some", other);
    EXPECT_NE(key_of_file(), whole) << at;
  }
  ContentKey key;
  EXPECT_FALSE(key.addFile(folder.path("nothing")));
  EXPECT_FALSE(key.addFile(folder.file("short", "1234"), 5));
}

TEST(SourceStates, TellWhatWasWrittenMeanwhile) {
  const palpate::testing::TempFolder folder;
  const std::vector<std::string> files = {folder.file("a", "1"), folder.file("b", "2")};
  ContentKey key;
  const SourceState state(files, key);
  EXPECT_TRUE(state.isKnown());
  EXPECT_TRUE(state.isUnchanged());
  fs::last_write_time(files[1], fs::last_write_time(files[1]) + std::chrono::nanoseconds(1));
  EXPECT_FALSE(state.isUnchanged());
  EXPECT_FALSE(SourceState({folder.path("nothing")}, key).isKnown());
  EXPECT_FALSE(SourceState({}, key).isKnown());
}

TEST(SourceStates, TellThatAnotherFileStoodInThePlaceMeanwhile) {
  const palpate::testing::TempFolder folder;
  const std::string file = folder.file("a", "1");
  const std::string other = folder.file("b", "2");
  fs::last_write_time(other, fs::last_write_time(file));
  ContentKey key;
  const SourceState state({file}, key);
  // The file system's clock ticks every 4 ms, or every 10.
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  fs::rename(file, folder.path("away"));
  fs::rename(other, file);
  EXPECT_FALSE(state.isUnchanged());
  fs::rename(file, other);
  fs::rename(folder.path("away"), file);
  EXPECT_FALSE(state.isUnchanged()) << "what was read meanwhile may be the other's";
}

TEST(SourceStates, TellThatAFileCameIntoAFolderOrLeftIt) {
  const palpate::testing::TempFolder folder;
  fs::create_directory(folder.path("masks"));
  const std::string file = folder.file("masks/a", "1");
  ContentKey key;
  const SourceState state({file}, key, {folder.path("masks")});
  EXPECT_TRUE(state.isUnchanged());
  (void)folder.file("masks/b", "2");
  EXPECT_FALSE(state.isUnchanged());
}

TEST(ImageFiles, WhoseVoxelsAreOfAnotherFileHaveNoKey) {
  const palpate::testing::TempFolder folder;
  const auto notes = std::make_shared<Notes>([](const std::string&) {});
  const test::Limb limb;
  const Image labels = limb.labels(test::obliqueAxes(Vec3(3.0)));
  const std::string path = test::writeNifti(labels, folder, "labels.nii");
  ImageFile same(path, ImageOptions{}, notes);
  (void)same.image();
  EXPECT_TRUE(same.state().isKnown());
  ImageFile other(path, ImageOptions{}, notes);
  (void)other.image();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  (void)test::writeNifti(limb.labels(test::obliqueAxes(Vec3(2.5))), folder, "labels.nii");
  EXPECT_FALSE(other.state().isKnown());
}

TEST(MeshFiles, AreTheMeshAndTheBuffersThatItNames) {
  const palpate::testing::TempFolder folder;
  (void)folder.file("a.bin", "1234");
  std::filesystem::create_directory(folder.path("more"));
  (void)folder.file("more/b \"1\".bin", "1234");
  using Names = std::vector<std::string>;
  const auto files = [&](const char* name, const std::string& text) {
    Names all;
    for (const std::string& file : meshFiles(folder.file(name, text))) {
      all.push_back(std::filesystem::path(file).lexically_relative(folder.path()).string());
    }
    return all;
  };
  EXPECT_EQ(files("a.gltf", R"({"buffers": [{"byteLength": 4, "uri" : "a.bin"}]})"),
            (Names{"a.gltf", "a.bin"}));
  EXPECT_EQ(files("b.GLTF", R"({"nodes":[{"buffers":[{"uri":"c.bin"}]}],"images":[{"uri":"t.png"}],
      "buffers":[{"uri":"data:,AA"},{"extras":{"uri":"d.bin"},"uri":"more\/b \"1\".bin"},
      {"uri":"a.bin","name":"uri"},{"uri":"a.bin"}],"asset":{"uri":"e.bin"}})"),
            (Names{"b.GLTF", "more/b \"1\".bin", "a.bin"}));
  EXPECT_EQ(files("c.gltf", R"({"buffers":[{"uri":"data:application/octet-stream;base64,A"}]})"),
            (Names{"c.gltf"}));
  EXPECT_EQ(files("c.obj", R"("buffers":[{"uri": "a.bin"}])"), (Names{"c.obj"}));
  const std::string json = R"({"buffers":[{"uri":"a.bin"}]})";
  const std::string head = std::string("glTF\2\0\0\0\0\0\0\0\0\0\0\0JSON", 20);
  EXPECT_EQ(files("a.glb", head + json + R"({"buffers":[{"uri":"other.bin"}]})"),
            (Names{"a.glb", "a.bin"}));
  EXPECT_EQ(files("b.glb", "glTF"), (Names{"b.glb"}));
  // If one file cannot be found, the list is empty; text that is cut short is not read beyond its
  // end.
  EXPECT_EQ(files("d.gltf", R"({"buffers":[{"uri":"gone.bin"}]})"), Names{});
  EXPECT_EQ(files("e.gltf", R"({"buffers":[{"uri":"https://host/a.bin"}]})"), Names{});
  EXPECT_EQ(files("f.gltf", R"({"buffers":[{"uri":"a.bin\)"), Names{});
  EXPECT_EQ(files("g.gltf", R"({"buffers":[{"uri")"), (Names{"g.gltf"}));
}

TEST(MakingLocks, BelongToOneAtATime) {
  const palpate::testing::TempFolder folder;
  {
    MakingLock one(folder.path(), keyOf(1));
    MakingLock same(folder.path(), keyOf(1));
    MakingLock other(folder.path(), keyOf(2));
    EXPECT_TRUE(one.take());
    EXPECT_TRUE(one.take()) << "whoever has it has it still";
    EXPECT_FALSE(same.take());
    EXPECT_TRUE(other.take());
    std::thread([&] { EXPECT_FALSE(same.take()); }).join();
  }
  MakingLock next(folder.path(), keyOf(1));
  EXPECT_TRUE(next.take());
  // Where a lock is impossible, nobody waits for it.
  MakingLock none(folder.path("no/such/folder"), keyOf(1));
  EXPECT_TRUE(none.take());
}

TEST(Seals, HoldForOneKeyAndOneContent) {
  const palpate::testing::TempFolder folder;
  const std::string path = folder.file("some", "content");
  ASSERT_TRUE(seal(path, keyOf(1)));
  EXPECT_TRUE(isSealed(path, keyOf(1)));
  EXPECT_FALSE(isSealed(path, keyOf(2)));
  EXPECT_EQ(fs::file_size(path), 7 + sealBytes(keyOf(1)));
  EXPECT_FALSE(isSealed(folder.path("nothing"), keyOf(1)));
  EXPECT_FALSE(isSealed(folder.file("empty", ""), keyOf(1)));
}

TEST(GridCaches, KeepWithinTheirBoundWhatWasUsedLast) {
  const palpate::testing::TempFolder folder;
  const std::string path = folder.path("cache");
  const LevelSet grid = ball(0.012);
  GridCache unbounded(path);
  unbounded.keep(keyOf(0), grid);
  const std::uint64_t each = fs::file_size(path + "/" + keyOf(0) + ".vdb");
  // A grid's memory must be at most a quarter of the limit.
  const std::uint64_t room = std::max<std::uint64_t>(4, 4 * grid.info().memory / each + 1);
  const GridCache cache(path, room * each + each / 2);
  (void)folder.file("cache/notes.vdb", std::string(10 * each, 'x'));  // not one of our files: stays
  (void)folder.file("cache/notes.part", "x");
  std::list<int> model = {0};  // the last used is at the end
  std::mt19937 random(17);
  auto now = fs::file_time_type::clock::now() - std::chrono::hours(24);
  for (int step = 0; step < 60; ++step) {
    const int n = static_cast<int>(random() % (2 * room));
    const std::string file = path + "/" + keyOf(n) + ".vdb";
    const bool is_there = std::find(model.begin(), model.end(), n) != model.end();
    const auto found = cache.find(keyOf(n), Sampler::kCubic);
    ASSERT_EQ(found.has_value(), is_there) << step;
    if (!is_there) {
      cache.keep(keyOf(n), grid);
    }
    model.remove(n);
    model.push_back(n);
    if (model.size() > room) model.pop_front();
    // Times of files may be as coarse as some milliseconds; here each use is a second later than
    // the one before.
    now += std::chrono::seconds(1);
    ASSERT_TRUE(fs::exists(file)) << step;
    fs::last_write_time(file, now);
    std::uint64_t all = 0;
    for (const auto& entry : fs::directory_iterator(path)) {
      if (entry.path().filename().string().starts_with("notes")) continue;
      all += entry.file_size();
    }
    ASSERT_LE(all, room * each + each / 2) << step;
  }
  EXPECT_TRUE(fs::exists(path + "/notes.vdb"));
  EXPECT_TRUE(fs::exists(path + "/notes.part"));
}

TEST(GridCaches, WhatKilledWritersLeftGoesAndWhatIsBeingWrittenStays) {
  const palpate::testing::TempFolder folder;
  const GridCache cache(folder.path("cache"));
  const LevelSet grid = ball(0.012);
  cache.keep(keyOf(0), grid);
  const std::string old = folder.file("cache/" + keyOf(1) + ".vdb.77-0.part", "half");
  const std::string fresh = folder.file("cache/" + keyOf(2) + ".vdb.78-0.part.78-0.part", "half");
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(2));
  cache.keep(keyOf(3), grid);
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(fresh));
}

TEST(GridCaches, TakeNoGridWithoutItsCertificate) {
  const palpate::testing::TempFolder folder;
  const GridCache cache(folder.path("cache"));
  BakeOptions options;
  options.voxel_size = 1e-3;
  cache.keep(keyOf(1), bake(*sphere(Vec3(0.0), 0.012), options));
  EXPECT_FALSE(cache.find(keyOf(1), Sampler::kCubic));
  cache.keep(keyOf(1), ball(0.012));
  EXPECT_TRUE(cache.find(keyOf(1), Sampler::kCubic));
  EXPECT_FALSE(cache.find(keyOf(1), Sampler::kTrilinear));
  cache.keepText(keyOf(1), "a few\nwords");
  EXPECT_EQ(cache.findText(keyOf(1)), "a few\nwords");
  EXPECT_FALSE(cache.findText(keyOf(2)));
}

}  // namespace
}  // namespace palpate::vdb
