// Foreign libraries that run in a child process.

#include "child/child.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include "fuzz/seeds.h"
#include "palpate/core/stop.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/mesh.h"
#include "support/error_of.h"
#include "support/temp_file.h"

namespace palpate::vdb {
namespace {

const ChildTask kTask{1000, "mesh.unreadable", "Assimp", "export it again", "a.glb"};

/// Limits for one test.
struct Limits {
  explicit Limits(const LibraryLimits& limits) : before(libraryLimits()) {
    setLibraryLimits(limits);
  }
  ~Limits() { setLibraryLimits(before); }
  LibraryLimits before;
};

[[noreturn]] void runForEver() {
  for (std::atomic<int> i = 0;; ++i) {
  }
}

TEST(Child, HandsBackWhatItMade) {
  ChildReader result = runInChild(kTask, [](ChildWriter& out) {
    out.put(42);
    out.put(std::string("a text"));
    out.put(std::vector<double>(300'000, 0.25));
  });
  EXPECT_EQ(result.take<int>(), 42);
  EXPECT_EQ(result.takeText(), "a text");
  EXPECT_EQ(result.takeAll<double>(), std::vector<double>(300'000, 0.25));
  EXPECT_THROW((void)result.take<int>(), std::out_of_range);
}

TEST(Child, AnErrorInItIsAnErrorHere) {
  const Error error = errorOf([] {
    (void)runInChild(kTask, [](ChildWriter&) {
      throw Error(ErrorKind::kInput,
                  {"mesh.index", "no such vertex", "a hint", "b.glb", 3, 4, "line"});
    });
  });
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.problem().code, "mesh.index");
  EXPECT_EQ(error.problem().hint, "a hint");
  EXPECT_EQ(error.problem().line, 3);
  EXPECT_EQ(error.problem().column, 4);
  EXPECT_EQ(error.problem().excerpt, "line");
}

TEST(Child, ACrashInItIsAnErrorHere) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE}) {
    const Error error = errorOf([&] {
      (void)runInChild(kTask, [&](ChildWriter&) {
        std::signal(signal, SIG_DFL);
        raise(signal);
      });
    });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problem().code, "mesh.unreadable");
    EXPECT_NE(error.problem().message.find("Assimp crashes"), std::string::npos) << error.what();
    EXPECT_EQ(error.problem().file, "a.glb");
  }
}

TEST(Child, OtherExceptionsInItAreErrorsHere) {
  const Error error = errorOf(
      [] { (void)runInChild(kTask, [](ChildWriter&) { throw std::runtime_error("strange"); }); });
  EXPECT_NE(error.problem().message.find("strange"), std::string::npos);
}

TEST(Child, OneThatNeverEndsIsEndedByItsLimit) {
  const Limits limits({.in_child = true, .seconds = 0.1});
  const Error error = errorOf([] { (void)runInChild(kTask, [](ChildWriter&) { runForEver(); }); });
  EXPECT_NE(error.problem().message.find("too long"), std::string::npos) << error.what();
}

TEST(Child, OneThatWantsAllMemoryIsRefusedIt) {
  const Limits limits({.in_child = true, .memory = std::uint64_t{64} << 20U});
  const auto work = [](ChildWriter& out) {
    // In builds with the address sanitizer there is no limit of memory: the half gigabyte is simply
    // allocated.
    std::vector<char> much(std::size_t{512} << 20U, 'x');
    out.put(much[1 << 20U]);
  };
#if defined(__SANITIZE_ADDRESS__)
  EXPECT_NO_THROW((void)runInChild(kTask, work));
#else
  const Error error = errorOf([&] { (void)runInChild(kTask, work); });
  EXPECT_NE(error.problem().message.find("too much memory"), std::string::npos) << error.what();
#endif
}

TEST(Child, AStopEndsTheWait) {
  std::atomic<bool> stop{false};
  watchStopFlag(&stop);
  std::thread stopper([&] { stop = true; });
  const Error error = errorOf([] { (void)runInChild(kTask, [](ChildWriter&) { runForEver(); }); });
  stopper.join();
  watchStopFlag(nullptr);
  EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
}

TEST(Child, AMeshReadInOneIsTheSame) {
  const palpate::testing::TempFolder folder;
  for (const char* name : {"glb", "gltf"}) {
    const std::string path = folder.file(std::string("a.") + name, fuzz::seedsOf(name).front());
    const Mesh plain = readMesh(path, 1e-3);
    const Limits limits({.in_child = true});
    const Mesh other = readMesh(path, 1e-3);
    EXPECT_EQ(other.vertices, plain.vertices);
    EXPECT_EQ(other.triangles, plain.triangles);
    EXPECT_EQ(other.dropped_triangles, plain.dropped_triangles);
    EXPECT_EQ(other.source, plain.source);
  }
}

TEST(Child, PackedPixelsReadInOneAreTheSame) {
  const palpate::testing::TempFolder folder;
  std::string slice = fuzz::seedsOf("dicom").back();
  (void)folder.file("1.dcm", slice);
  const std::size_t place = slice.find("0\\0\\0");
  slice.replace(place, 5, "0\\0\\1");
  (void)folder.file("2.dcm", slice);
  const Image plain = readImage(folder.path("1.dcm"));
  const Limits limits({.in_child = true});
  const Image other = readImage(folder.path("1.dcm"));
  EXPECT_EQ(plain.values, other.values);
  for (const float value : plain.values) EXPECT_EQ(value, -995.0F) << "5 as stored, less 1000";
}

}  // namespace
}  // namespace palpate::vdb
