// Which settings of its thread the servo loop changes, and that it does so only when asked.

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

#include <atomic>

#include "palpate/devices/device.h"
#include "palpate/devices/path.h"

namespace palpate::devices {
namespace {

const std::atomic<bool> kNeverStop{false};

/// [ns] The delay with which the kernel may wake this thread.
int slack() { return prctl(PR_GET_TIMERSLACK, 0, 0, 0, 0); }

/// The slack within a tick of a loop with these settings.
int slackDuring(const ServoSettings& settings) {
  VirtualDevice device({{0.0, Vec3(0.0)}});
  int out = -1;
  const ServoTick tick = [&](const DeviceState& /*state*/) {
    out = slack();
    return Vec3(0.0);
  };
  static_cast<void>(runServo(device, tick, settings, kNeverStop));
  return out;
}

TEST(ServoClock, ALoopByTheClockSleepsExactlyAndGivesTheSlackBack) {
  // Set a slack, which only threads without a real-time priority have.
  const sched_param none{};
  ASSERT_EQ(pthread_setschedparam(pthread_self(), SCHED_OTHER, &none), 0);
  constexpr int kSlack = 70'000;  // [ns]
  ASSERT_EQ(prctl(PR_SET_TIMERSLACK, kSlack, 0, 0, 0), 0);
  ASSERT_EQ(slack(), kSlack);
  EXPECT_EQ(slackDuring({.realtime = true}), 1);
  EXPECT_EQ(slack(), kSlack);
  EXPECT_EQ(slackDuring({.realtime = false}), kSlack) << "nothing sleeps, nothing is changed";
  EXPECT_EQ(slack(), kSlack);
}

TEST(ServoClock, NeitherPriorityNorMemoryIsTakenUnlessAskedFor) {
  int policy = -1;
  int during = -1;
  sched_param param{};
  ASSERT_EQ(pthread_getschedparam(pthread_self(), &policy, &param), 0);
  VirtualDevice device({{0.0, Vec3(0.0)}});
  const ServoTick tick = [&](const DeviceState& /*state*/) {
    pthread_getschedparam(pthread_self(), &during, &param);
    return Vec3(0.0);
  };
  const ServoReport report =
      runServo(device, tick, {.realtime = true, .elevate = Elevate::kOff}, kNeverStop);
  EXPECT_EQ(during, policy);
  EXPECT_FALSE(report.has_priority);
  EXPECT_FALSE(report.has_locked_memory);
  EXPECT_FALSE(report.elevated);
}

}  // namespace
}  // namespace palpate::devices
