// A session that another thread observes, and to which it hands another scene.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "palpate/devices/path.h"
#include "palpate/devices/seq_lock.h"
#include "palpate/devices/session.h"
#include "palpate/scene/scene_file.h"
#include "support/alloc_guard.h"
#include "support/wait.h"

namespace palpate::devices {
namespace {

/// A block below `height` [mm], with a wall of stiffness `stiffness` [N/m].
ScenePtr floorScene(double height, double stiffness) {
  return compile(parseScene(
      "palpate: 1\nlength: mm\nmaterials:\n  wall: {stiffness: " + std::to_string(stiffness) +
          " N/m}\nlayers:\n  - {name: floor, inside: {box: {center: [0, 0, " +
          std::to_string(height - 50.0) + "], size: [100, 100, 100]}}, wall: wall}\n",
      "floor.yaml"));
}

TEST(SeqLock, AValueIsSeenWhole) {
  struct Pair {
    std::uint64_t a, b, c;
  };
  SeqLock<Pair> lock;
  EXPECT_FALSE(lock.load());
  constexpr std::uint64_t kStores = 200'000;
  std::jthread writer([&] {
    for (std::uint64_t i = 1; i <= kStores; ++i) lock.store({i, 2 * i, 3 * i});
  });
  std::uint64_t last = 0;
  const testing::Deadline deadline;
  while (last < kStores && !deadline.hasPassed()) {
    const auto seen = lock.load();
    if (!seen) continue;
    ASSERT_EQ(seen->b, 2 * seen->a);
    ASSERT_EQ(seen->c, 3 * seen->a);
    ASSERT_GE(seen->a, last);
    last = seen->a;
  }
  writer.join();
  EXPECT_EQ(last, kStores);
}

TEST(LiveSession, TheViewIsTheLastTick) {
  Session session(floorScene(0.0, 1000.0));
  EXPECT_FALSE(session.view());
  DeviceState reading;
  reading.position = Vec3(0.0, 0.0, -1e-3);
  const SessionTick tick = session.step(reading, DeviceFrame::kWorld);
  const auto view = session.view();
  ASSERT_TRUE(view);
  EXPECT_EQ(view->number, 0U);
  EXPECT_EQ(view->force, tick.result.force);
  EXPECT_EQ(view->proxy, tick.result.proxy);
}

TEST(LiveSession, AnotherSceneIsFeltFromZeroAndNothingIsFreedInTheLoop) {
  Session session(floorScene(0.0, 1000.0));
  DeviceState reading;
  const auto step = [&] {
    reading.time += 1e-3;
    return session.step(reading, DeviceFrame::kWorld);
  };
  reading.position = Vec3(0.0, 0.0, 1e-3);
  (void)step();
  reading.position = Vec3(0.0, 0.0, -1e-3);
  EXPECT_NEAR(step().force.z, 1.0, 1e-9);
  session.offer(floorScene(0.0, 3000.0), {});
  {
    const testing::AllocGuard guard;
    EXPECT_EQ(step().force, Vec3(0.0));
    for (int i = 1; i < 100; ++i) {
      ASSERT_NEAR(step().force.z, 3.0 * i / 100.0, 1e-9) << i;
    }
    EXPECT_EQ(guard.violations(), 0);
  }
  EXPECT_NEAR(step().force.z, 3.0, 1e-9);
}

TEST(LiveSession, ScenesThatAnotherThreadOffersAreTakenOneAfterTheOther) {
  Session session(floorScene(0.0, 1000.0));
  std::atomic<bool> is_over{false};
  std::atomic<int> offered{0};
  std::jthread world([&] {
    for (int i = 0; i < 50; ++i) {
      session.offer(floorScene(0.0, 1000.0 + i), {});
      ++offered;
      (void)session.view();
    }
    is_over = true;
  });
  DeviceState reading;
  reading.position = Vec3(0.0, 0.0, -1e-3);
  int ticks = 0;
  while (!is_over || ticks < 300) {
    reading.time += 1e-3;
    const SessionTick tick = session.step(reading, DeviceFrame::kWorld);
    ASSERT_TRUE(isFinite(tick.force));
    ASSERT_LE(tick.force.z, 1.05 + 1e-9);
    ticks = is_over ? ticks + 1 : ticks;
  }
  world.join();
  EXPECT_EQ(offered, 50);
  reading.time += 1e-3;
  EXPECT_GT(session.step(reading, DeviceFrame::kWorld).force.z, 0.99);
}

}  // namespace
}  // namespace palpate::devices
