// Sharing between threads: one scene, felt by several renderers at a time, each in its own thread.

#include <gtest/gtest.h>

#include <cstring>
#include <thread>
#include <vector>

#include "lib/render/drive.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

constexpr std::size_t kThreads = 4;
constexpr int kTicks = 3'000;

/// The results of a hand that wanders through the scene, the same for the same seed.
std::vector<TickResult> felt(const ScenePtr& scene, RendererKind kind, std::uint64_t seed) {
  Drive drive(scene, kind);
  Random random(seed);
  const Box3 box = scene->bounds().grownBy(0.01);
  std::vector<TickResult> trace;
  trace.reserve(kTicks);
  Vec3 hip = random.in(box);
  Vec3 goal = hip;
  for (int i = 0; i < kTicks; ++i) {
    if (i % 40 == 0) goal = random.in(box);
    hip += 0.05 * (goal - hip);
    trace.push_back(drive.to(hip));
  }
  return trace;
}

bool sameBits(const Vec3& a, const Vec3& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void expectSame(const std::vector<TickResult>& a, const std::vector<TickResult>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(sameBits(a[i].force, b[i].force) && sameBits(a[i].proxy, b[i].proxy)) << i;
    ASSERT_EQ(a[i].region, b[i].region) << i;
    ASSERT_EQ(a[i].event_count, b[i].event_count) << i;
  }
}

TEST(SharedScene, EachRendererFeelsWhatItFeelsAlone) {
  for (const char* name : {"container", "fields", "flag"}) {
    SCOPED_TRACE(name);
    const ScenePtr scene = sceneNamed(name);
    std::vector<std::vector<TickResult>> together(kThreads);
    std::vector<std::thread> threads;
    for (std::size_t n = 0; n < kThreads; ++n) {
      threads.emplace_back(
          [&, n] { together[n] = felt(scene, RendererKind::kConstraint, 10 + n); });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::size_t n = 0; n < kThreads; ++n) {
      SCOPED_TRACE(n);
      expectSame(together[n], felt(scene, RendererKind::kConstraint, 10 + n));
    }
  }
}

TEST(SharedScene, BothRenderersOnOneScene) {
  const ScenePtr scene = sceneNamed("container");
  std::vector<TickResult> constraint, paper;
  std::thread one([&] { constraint = felt(scene, RendererKind::kConstraint, 3); });
  std::thread two([&] { paper = felt(scene, RendererKind::kPaper, 3); });
  one.join();
  two.join();
  expectSame(constraint, felt(scene, RendererKind::kConstraint, 3));
  expectSame(paper, felt(scene, RendererKind::kPaper, 3));
}

TEST(SharedScene, ScenesAreCompiledAtTheSameTime) {
  std::vector<ScenePtr> scenes(kThreads);
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < kThreads; ++n) {
    threads.emplace_back([&, n] { scenes[n] = sceneNamed("fields"); });
  }
  for (std::thread& thread : threads) thread.join();
  const std::vector<TickResult> first = felt(scenes[0], RendererKind::kConstraint, 5);
  for (std::size_t n = 1; n < kThreads; ++n) {
    expectSame(felt(scenes[n], RendererKind::kConstraint, 5), first);
  }
}

}  // namespace
}  // namespace palpate::test
