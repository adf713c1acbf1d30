// The servo loop when readings stop, when the device's limits are invalid, and while it sleeps.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "devices/scripted_device.h"
#include "palpate/devices/device.h"
#include "palpate/devices/reading_watch.h"
#include "support/alloc_guard.h"
#include "support/wait.h"

namespace palpate::devices {
namespace {

constexpr auto kOk = DeviceStatus::kOk;
constexpr auto kStale = DeviceStatus::kStale;
const std::atomic<bool> kNeverStop{false};
const Vec3 kPush(0.0, 0.0, 5.0);

Vec3 push(const DeviceState& /*state*/) { return kPush; }

/// One reading, then `stale` turns without one, then `more` readings.
void script(ScriptedDevice& device, std::size_t stale, std::size_t more) {
  device.reads.assign(1, kOk);
  device.reads.insert(device.reads.end(), stale, kStale);
  device.reads.insert(device.reads.end(), more, kOk);
}

TEST(ServoSafety, TwentyMillisecondsWithoutAReadingAndTheForceIsZero) {
  ScriptedDevice device;
  script(device, 500, 0);
  const ServoReport report = runServo(device, push, {}, kNeverStop);
  ASSERT_EQ(device.written.size(), 502U);  // one each turn, and the final zero
  // A turn stands for 1 ms: the reading is 19 ms old at turn 19, and 20 ms at turn 20.
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(device.written[i], kPush) << i;
  for (std::size_t i = 20; i < 502; ++i) EXPECT_EQ(device.written[i], Vec3(0.0)) << i;
  EXPECT_EQ(report.ticks, 20U) << "the tick is not asked about a hand that nobody knows";
  EXPECT_EQ(report.stale, 481U);
}

TEST(ServoSafety, AnObserverSeesWhatBecameOfEachForce) {
  ScriptedDevice device;
  script(device, 30, 200);
  device.nan_positions = {40};
  device.max_force = 4.0;  // less than the 5 N that are asked for
  std::vector<ServoTurn> turns;
  turns.reserve(1000);
  const auto observe = [&](const ServoTurn& turn) { turns.push_back(turn); };
  const ServoReport report = runServo(device, push, {}, kNeverStop, observe);
  ASSERT_EQ(turns.size(), report.ticks);
  ASSERT_EQ(turns.size(), 20U + 200U) << "ticks, not turns that wrote zero without one";
  std::uint64_t zeroed = 0;
  std::uint64_t shortened = 0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const std::size_t written_at = i < 20 ? i : i + 11;
    ASSERT_EQ(turns[i].written, device.written[written_at]) << i;
    ASSERT_EQ(turns[i].is_stale, i > 0 && i < 20) << i;
    ASSERT_NEAR(glm::length(turns[i].written), turns[i].is_zeroed ? 0.0 : 4.0 * turns[i].share,
                1e-12);
    zeroed += turns[i].is_zeroed ? 1 : 0;
    shortened += turns[i].is_shortened ? 1 : 0;
  }
  EXPECT_EQ(zeroed, 1U);
  EXPECT_EQ(zeroed, report.zeroed);
  EXPECT_EQ(shortened, report.shortened);
  EXPECT_EQ(turns[20].share, 0.0) << "after the watchdog from zero";
  EXPECT_EQ(turns.back().share, 1.0);
}

TEST(ServoSafety, TheWatchdogCountsInTimeNotInTurns) {
  ScriptedDevice device;
  script(device, 500, 0);
  const ServoReport report = runServo(device, push, {.rate = 10000.0}, kNeverStop);
  EXPECT_EQ(report.ticks, 200U);
  ScriptedDevice patient;
  script(patient, 500, 0);
  EXPECT_EQ(runServo(patient, push, {.watchdog = 0.1}, kNeverStop).ticks, 100U);
  // However slow the loop is, one turn may pass without a reading.
  ScriptedDevice slow;
  script(slow, 10, 0);
  EXPECT_EQ(runServo(slow, push, {.rate = 20.0}, kNeverStop).ticks, 2U);
}

TEST(ServoSafety, WhenReadingsComeAgainTheForceGrowsFromZero) {
  ScriptedDevice device;
  script(device, 50, 200);
  static_cast<void>(runServo(device, push, {}, kNeverStop));
  const std::size_t back = 51;
  EXPECT_EQ(device.written[back - 1], Vec3(0.0));
  EXPECT_EQ(device.written[back], Vec3(0.0));
  for (std::size_t i = 0; i < 200; ++i) {
    // 5 N are reached within 0.1 s.
    EXPECT_NEAR(device.written[back + i].z, std::min(5.0, 0.05 * static_cast<double>(i)), 1e-12)
        << i;
  }
}

TEST(ServoSafety, SilenceWhileItRecoversBeginsAnew) {
  ReadingWatch watch(20, 100);
  watch.turn(1, true);
  watch.turn(21, false);
  EXPECT_TRUE(watch.hasExpired());
  watch.turn(30, true);
  EXPECT_FALSE(watch.hasExpired());
  watch.turn(80, true);
  EXPECT_DOUBLE_EQ(watch.share(), 0.5);
  watch.turn(100, false);
  EXPECT_TRUE(watch.hasExpired());
  watch.turn(110, true);
  EXPECT_DOUBLE_EQ(watch.share(), 0.0);
  watch.turn(209, true);
  EXPECT_DOUBLE_EQ(watch.share(), 0.99);
  watch.turn(210, true);
  EXPECT_DOUBLE_EQ(watch.share(), 1.0);
}

TEST(ServoSafety, RealtimeWatchesTheClock) {
  // Readings stop for 300 turns of 0.2 ms. All turns after 20 ms write zero, on a slow machine too:
  // late turns only make the reading older.
  ScriptedDevice device;
  script(device, 300, 0);
  const ServoReport report = runServo(device, push, {.realtime = true, .rate = 5000.0}, kNeverStop);
  EXPECT_GE(report.stale, 200U);
  EXPECT_EQ(device.written[300], Vec3(0.0));
}

TEST(ServoSafety, ADeviceWhoseMaximumIsNoNumberOrBelowZeroIsWrittenZero) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), -3.0, -kInfinity, 0.0}) {
    ScriptedDevice device;
    device.max_force = bad;
    device.reads.assign(5, kOk);
    const ServoReport report = runServo(device, push, {}, kNeverStop);
    EXPECT_EQ(report.ticks, 5U);
    for (const Vec3& force : device.written) EXPECT_EQ(force, Vec3(0.0)) << bad;
  }
}

TEST(ServoSafety, AStopWhileItSleepsIsSeenAtOnce) {
  // At 1 Hz the next tick is a second away; another thread's stop does not wake the sleeper.
  ScriptedDevice device;
  device.reads.assign(1000, kOk);
  std::atomic<bool> stop{false};
  std::atomic<bool> has_ticked{false};
  std::thread stopper([&] {
    (void)testing::waitUntil([&] { return has_ticked.load(); });
    stop = true;
  });
  const ServoReport report = runServo(
      device,
      [&](const DeviceState& /*state*/) {
        has_ticked = true;
        return kPush;
      },
      {.realtime = true, .rate = 1.0}, stop);
  stopper.join();
  EXPECT_EQ(report.exit, ServoExit::kStopped);
  EXPECT_EQ(report.ticks, 1U) << "stopped before the next tick";
  EXPECT_EQ(report.overruns, 0U);
  EXPECT_EQ(device.written.back(), Vec3(0.0));
}

TEST(ServoSafety, RefusesAWatchdogOrRecoveryThatIsNoTime) {
  ScriptedDevice device;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, nan, kInfinity}) {
    EXPECT_THROW(static_cast<void>(runServo(device, push, {.watchdog = bad}, kNeverStop)), Error);
  }
  for (const double bad : {-1.0, nan, kInfinity}) {
    EXPECT_THROW(static_cast<void>(runServo(device, push, {.recovery = bad}, kNeverStop)), Error);
  }
  EXPECT_EQ(device.opened, 0);
}

TEST(ServoSafety, TheWatchdogNeitherAllocatesNorLocks) {
  ScriptedDevice device;
  script(device, 40, 40);
  const ServoTick tick = push;
  ServoReport report;
  const testing::AllocGuard guard;
  report = runServo(device, tick, {}, kNeverStop);
  EXPECT_EQ(guard.violations(), 0);
  EXPECT_GT(report.stale, 0U);
}

}  // namespace
}  // namespace palpate::devices
