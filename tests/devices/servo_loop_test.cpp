#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <stdexcept>
#include <utility>

#include "devices/scripted_device.h"
#include "palpate/core/error.h"
#include "palpate/devices/device.h"
#include "palpate/devices/path.h"
#include "support/alloc_guard.h"
#include "support/error_of.h"
#include "support/wait.h"

namespace palpate::devices {
namespace {

constexpr auto kOk = DeviceStatus::kOk;
constexpr auto kStale = DeviceStatus::kStale;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const std::atomic<bool> kNeverStop{false};
const Vec3 kPush(0.0, 0.0, 1.0);

Vec3 push(const DeviceState& /*state*/) { return kPush; }

/// Every end of the loop leaves the device in this state.
void expectAtRest(const ScriptedDevice& device) {
  ASSERT_FALSE(device.written.empty());
  EXPECT_EQ(device.written.back(), Vec3(0.0));
  EXPECT_EQ(device.opened, 1);
  EXPECT_EQ(device.closed, 1);
  EXPECT_FALSE(device.wrote_while_closed);
}

TEST(RunServo, PlaysAPathFromEndToEnd) {
  VirtualDevice device({{0.0, Vec3(0.0)}, {0.1, Vec3(1.0)}, {0.2, Vec3(3.0)}});
  std::vector<DeviceState> seen;
  std::vector<Vec3> forces_before;
  const ServoReport report = runServo(
      device,
      [&](const DeviceState& state) {
        forces_before.push_back(device.lastForce());
        seen.push_back(state);
        return Vec3(state.time);
      },
      {}, kNeverStop);
  EXPECT_EQ(report.exit, ServoExit::kEnd);
  EXPECT_EQ(report.ticks, 3U);
  EXPECT_EQ(report.zeroed, 0U);
  EXPECT_EQ(report.overruns, 0U);
  EXPECT_FALSE(report.elevated);
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[2].position, Vec3(3.0));
  EXPECT_DOUBLE_EQ(seen[2].velocity.x, 20.0);
  // Each force was written before the next reading.
  EXPECT_EQ(forces_before[1], Vec3(0.0));
  EXPECT_EQ(forces_before[2], Vec3(0.1));
  EXPECT_EQ(device.lastForce(), Vec3(0.0));
}

class RunServoLeaves : public ::testing::TestWithParam<std::pair<DeviceStatus, ServoExit>> {};

TEST_P(RunServoLeaves, WhenReadingFails) {
  ScriptedDevice device;
  device.reads = {kOk, kOk, GetParam().first, kOk};
  const ServoReport report = runServo(device, push, {}, kNeverStop);
  EXPECT_EQ(report.exit, GetParam().second);
  const bool is_fault = report.exit != ServoExit::kEnd;
  EXPECT_EQ(report.fault, is_fault ? SafetyFault::kDevice : SafetyFault::kNone);
  EXPECT_EQ(report.ticks, 2U);
  EXPECT_EQ(device.written, (std::vector<Vec3>{kPush, kPush, Vec3(0.0)}));
  expectAtRest(device);
}

TEST_P(RunServoLeaves, WhenWritingFails) {
  ScriptedDevice device;
  device.reads.assign(10, kOk);
  device.writes = {kOk, GetParam().first};
  const ServoReport report = runServo(device, push, {}, kNeverStop);
  EXPECT_EQ(report.exit, GetParam().second);
  EXPECT_EQ(report.ticks, 2U);
  expectAtRest(device);
}

TEST_P(RunServoLeaves, WhenTheFirstReadingFails) {
  ScriptedDevice device;
  device.reads = {GetParam().first};
  const ServoReport report = runServo(device, push, {}, kNeverStop);
  EXPECT_EQ(report.exit, GetParam().second);
  EXPECT_EQ(report.ticks, 0U);
  expectAtRest(device);
}

INSTANTIATE_TEST_SUITE_P(Statuses, RunServoLeaves,
                         ::testing::Values(std::pair{DeviceStatus::kEnd, ServoExit::kEnd},
                                           std::pair{DeviceStatus::kTimeout, ServoExit::kTimeout},
                                           std::pair{DeviceStatus::kDisconnected,
                                                     ServoExit::kDisconnected},
                                           std::pair{DeviceStatus::kFault, ServoExit::kFault}));

TEST(RunServo, AStaleReadingIsThePreviousOneAgain) {
  ScriptedDevice device;
  device.reads = {kOk, kOk, kStale, kStale, kOk};
  std::vector<double> x;
  const ServoReport report = runServo(
      device,
      [&](const DeviceState& state) {
        x.push_back(state.position.x);
        return kPush;
      },
      {}, kNeverStop);
  EXPECT_EQ(report.exit, ServoExit::kEnd);
  EXPECT_EQ(x, (std::vector<double>{0.0, 1.0, 1.0, 1.0, 4.0}));
  expectAtRest(device);
}

TEST(RunServo, BeforeTheFirstReadingNothingIsTickedAndNothingPushed) {
  ScriptedDevice device;
  device.reads = {kStale, kStale, kOk};
  const ServoReport report = runServo(device, push, {}, kNeverStop);
  EXPECT_EQ(report.ticks, 1U);
  EXPECT_EQ(device.written, (std::vector<Vec3>{Vec3(0.0), Vec3(0.0), kPush, Vec3(0.0)}));
}

TEST(RunServo, AForceThatIsNotFiniteIsWrittenAsZeroAndTheLoopGoesOn) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    ScriptedDevice device;
    device.reads.assign(3, kOk);
    const ServoReport report = runServo(
        device,
        [&](const DeviceState& state) {
          return state.position.x == 1.0 ? Vec3(0.0, bad, 0.0) : kPush;
        },
        {}, kNeverStop);
    EXPECT_EQ(device.written, (std::vector<Vec3>{kPush, Vec3(0.0), kPush, Vec3(0.0)}));
    EXPECT_EQ(report.ticks, 3U);
    EXPECT_EQ(report.zeroed, 1U);
    expectAtRest(device);
  }
}

TEST(RunServo, AForceBeyondTheDevicesMaximumIsShortenedAndKeepsItsDirection) {
  ScriptedDevice device;  // holds 10 N
  device.reads.assign(3, kOk);
  const Vec3 forces[] = {{0.0, 6.0, 8.0}, {0.0, -30.0, 40.0}, {1e300, 0.0, 0.0}};
  std::size_t tick = 0;
  const ServoReport report = runServo(
      device, [&](const DeviceState& /*state*/) { return forces[tick++]; }, {}, kNeverStop);
  EXPECT_EQ(report.shortened, 2U);
  EXPECT_EQ(report.zeroed, 0U);
  ASSERT_EQ(device.written.size(), 4U);
  EXPECT_EQ(device.written[0], forces[0]);
  EXPECT_NEAR(device.written[1].y, -6.0, 1e-14);
  EXPECT_NEAR(device.written[1].z, 8.0, 1e-14);
  EXPECT_LE(glm::length(device.written[2]), 10.0);  // its square overflows: at most 10 N
  expectAtRest(device);
}

TEST(RunServo, ANanPositionGivesZeroForceWhateverTheTickSays) {
  ScriptedDevice device;
  device.reads.assign(3, kOk);
  device.nan_positions = {1};
  const ServoReport report = runServo(device, push, {}, kNeverStop);
  EXPECT_EQ(device.written, (std::vector<Vec3>{kPush, Vec3(0.0), kPush, Vec3(0.0)}));
  EXPECT_EQ(report.zeroed, 1U);
}

TEST(RunServo, StopEndsItBeforeTheNextReading) {
  ScriptedDevice device;
  device.reads.assign(100, kOk);
  std::atomic<bool> stop{false};
  const ServoReport report = runServo(
      device,
      [&](const DeviceState& state) {
        if (state.position.x == 4.0) stop = true;
        return kPush;
      },
      {}, stop);
  EXPECT_EQ(report.exit, ServoExit::kStopped);
  EXPECT_EQ(report.ticks, 5U);
  expectAtRest(device);
}

TEST(RunServo, StoppedBeforehandStillLeavesTheDeviceAtRest) {
  ScriptedDevice device;
  device.reads.assign(100, kOk);
  const std::atomic<bool> stop{true};
  for (const bool realtime : {false, true}) {
    const ServoReport report = runServo(device, push, {.realtime = realtime}, stop);
    EXPECT_EQ(report.exit, ServoExit::kStopped);
    EXPECT_EQ(report.ticks, 0U);
    EXPECT_EQ(device.written.back(), Vec3(0.0));
  }
  EXPECT_EQ(device.opened, 2);
  EXPECT_EQ(device.closed, 2);
}

TEST(RunServo, ATickThatThrowsAgainstItsContractLeavesTheDeviceAtRest) {
  ScriptedDevice device;
  device.reads.assign(5, kOk);
  const auto tick = [](const DeviceState& state) -> Vec3 {
    if (state.position.x == 2.0) throw std::runtime_error("broken tick");
    return kPush;
  };
  EXPECT_THROW(static_cast<void>(runServo(device, tick, {}, kNeverStop)), std::runtime_error);
  expectAtRest(device);
}

TEST(RunServo, FailingToOpenThrowsAndNothingIsWrittenOrClosed) {
  ScriptedDevice device;
  device.fails_to_open = true;
  try {
    static_cast<void>(runServo(device, push, {}, kNeverStop));
    FAIL() << "ran";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kDevice);
  }
  EXPECT_TRUE(device.written.empty());
  EXPECT_EQ(device.closed, 0);
}

TEST(RunServo, RefusesAnEmptyTickAndABadRateBeforeOpening) {
  ScriptedDevice device;
  EXPECT_THROW(static_cast<void>(runServo(device, {}, {}, kNeverStop)), Error);
  for (const double rate : {0.0, -5.0, 0.1, 1e7, kNan}) {
    const ServoSettings settings{.realtime = true, .rate = rate};
    EXPECT_THROW(static_cast<void>(runServo(device, push, settings, kNeverStop)), Error);
  }
  EXPECT_EQ(device.opened, 0);
}

TEST(RunServo, TheLoopIsFreeOfAllocationsLocksAndThrows) {
  for (const bool realtime : {false, true}) {
    ScriptedDevice device;
    device.reads = {kStale, kOk, kOk, kStale, kOk, kOk, kOk};
    device.nan_positions = {2};
    const ServoTick tick = [](const DeviceState& state) {
      return state.position.x == 4.0 ? Vec3(kNan) : kPush;
    };
    ServoReport report;
    const testing::AllocGuard guard;
    // The watchdog's time is long: on a busy machine a turn may come late.
    report = runServo(device, tick, {.realtime = realtime, .rate = 10000.0, .watchdog = 100.0},
                      kNeverStop);
    EXPECT_EQ(guard.violations(), 0);
    EXPECT_EQ(report.ticks, 6U);
    // The NaN reading, the stale one that repeats it, and the NaN force.
    EXPECT_EQ(report.zeroed, 3U);
  }
}

TEST(RunServo, RealtimeRunsTheSameTicks) {
  ScriptedDevice device;
  device.reads = {kOk, kStale, kOk};
  const ServoSettings settings{.realtime = true, .rate = 5000.0, .watchdog = 100.0};
  const ServoReport report = runServo(device, push, settings, kNeverStop);
  EXPECT_EQ(report.exit, ServoExit::kEnd);
  EXPECT_EQ(report.ticks, 3U);
  EXPECT_GE(report.worst_lateness, 0.0);
  expectAtRest(device);
}

TEST(RunServo, ElevationIsReportedAndUndone) {
  int policy = -1;
  int during = -1;
  sched_param before{};
  ASSERT_EQ(pthread_getschedparam(pthread_self(), &policy, &before), 0);
  VirtualDevice device({{0.0, Vec3(0.0)}});
  const ServoReport report = runServo(
      device,
      [&](const DeviceState& /*state*/) {
        sched_param param{};
        pthread_getschedparam(pthread_self(), &during, &param);
        return Vec3(0.0);
      },
      {.elevate = Elevate::kPrefer}, kNeverStop);
  // The permitted priority depends on the user who runs the test; the report must agree with what
  // happened.
  EXPECT_EQ(during, report.has_priority ? SCHED_FIFO : policy);
  EXPECT_EQ(report.elevated, report.has_priority && report.has_locked_memory);
  int policy_after = -1;
  sched_param after{};
  ASSERT_EQ(pthread_getschedparam(pthread_self(), &policy_after, &after), 0);
  EXPECT_EQ(policy_after, policy);
  EXPECT_EQ(after.sched_priority, before.sched_priority);
}

/// A virtual device that notes under which policy and priority its force is cut.
class CutDevice final : public ScriptedDevice {
 public:
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return limited_; }
  void cut() noexcept override {
    sched_param param{};
    pthread_getschedparam(pthread_self(), &policy, &param);
    priority = param.sched_priority;
    is_cut.store(true, std::memory_order_release);
  }
  int policy = -1;
  int priority = -1;
  std::atomic<bool> is_cut{false};

 private:
  DeviceInfo limited_ = [] {
    DeviceInfo info{"hanging", 10.0, {}};
    info.limits.hang = 0.02;
    return info;
  }();
};

TEST(RunServo, TheThreadThatWatchesALoopWithPriorityStandsAboveIt) {
  CutDevice device;
  device.reads = {kOk, kOk};
  int policy = -1;
  sched_param own{};
  const auto hang = [&](const DeviceState& /*state*/) {
    pthread_getschedparam(pthread_self(), &policy, &own);
    EXPECT_TRUE(testing::waitUntil([&] { return device.is_cut.load(std::memory_order_acquire); }));
    return Vec3(0.0);
  };
  const ServoReport report =
      runServo(device, hang, {.realtime = true, .elevate = Elevate::kPrefer}, kNeverStop);
  // Whether priorities are permitted depends on the user who runs the test; without, it still cuts.
  EXPECT_EQ(device.policy, policy);
  EXPECT_EQ(device.priority, own.sched_priority + (report.has_priority ? 1 : 0));
}

TEST(RunServo, WhatIsRequiredIsGrantedOrTheLoopDoesNotRun) {
  // The permission depends on the user who runs the test: both results are accepted, whichever the
  // system states.
  ScriptedDevice device;
  device.reads = {DeviceStatus::kOk, DeviceStatus::kOk};
  VirtualDevice asked({{0.0, Vec3(0.0)}});
  const auto zero = [](const DeviceState& /*state*/) { return Vec3(0.0); };
  const bool is_granted = runServo(asked, zero, {.elevate = Elevate::kPrefer}, kNeverStop).elevated;
  if (is_granted) {
    EXPECT_TRUE(runServo(device, zero, {.elevate = Elevate::kRequire}, kNeverStop).elevated);
  } else {
    const Error error =
        errorOf([&] { (void)runServo(device, zero, {.elevate = Elevate::kRequire}, kNeverStop); });
    EXPECT_EQ(error.kind(), ErrorKind::kOperation);
    EXPECT_EQ(error.problem().code, "servo.elevate");
  }
  expectAtRest(device);
}

}  // namespace
}  // namespace palpate::devices
