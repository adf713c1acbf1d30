// A record that fails on request: each fault leads to its state, its text and zero force.

#include "palpate/devices/replay_device.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palpate/devices/device.h"
#include "palpate/devices/path.h"
#include "palpate/devices/record.h"
#include "support/error_of.h"
#include "support/temp_file.h"

namespace palpate::devices {
namespace {

const std::atomic<bool> kNeverStop{false};
const Vec3 kPush(0.0, 0.0, 1.0);

/// A hand that moves back and forth for 2 s.
std::vector<DeviceState> rows() {
  std::vector<DeviceState> out;
  for (int i = 0; i < 2000; ++i) {
    DeviceState row;
    row.time = 1e-3 * i;
    row.position = Vec3(0.01 * std::sin(row.time), 0.0, 0.0);
    out.push_back(row);
  }
  return out;
}

DeviceInfo hand() {
  DeviceInfo info{"replay", 10.0, {}};
  info.limits = handLimits();
  return info;
}

struct Played {
  ServoReport report;
  std::vector<double> forces;
  Vec3 left{1.0};
};

Played play(std::vector<InjectedFault> faults) {
  ReplayDevice device(rows(), hand(), std::move(faults));
  Played out;
  out.report = runServo(
      device, [](const DeviceState&) { return kPush; }, {}, kNeverStop,
      [&](const ServoTurn& turn) { out.forces.push_back(glm::length(turn.written)); });
  out.left = device.lastForce();
  return out;
}

TEST(ReplayDevice, SaysWhatTheRecordHasAndEnds) {
  const Played run = play({});
  EXPECT_EQ(run.report.exit, ServoExit::kEnd);
  EXPECT_EQ(run.report.ticks, 2000U);
  EXPECT_NEAR(run.forces.back(), 1.0, 1e-12);
  EXPECT_EQ(run.left, Vec3(0.0));
}

struct Case {
  InjectedFault fault;
  ServoExit exit;
  SafetyFault why;
  std::uint64_t ticks;
};

TEST(ReplayDevice, EachFaultLeadsToItsStateAndZeroForce) {
  using K = InjectedKind;
  const Case cases[] = {
      // In nine turns without a reading the last one is used; then the force is zero until a
      // reading comes.
      {{1000, K::kStale, 1}, ServoExit::kEnd, SafetyFault::kNone, 2001},
      {{1000, K::kStale, 50}, ServoExit::kEnd, SafetyFault::kNone, 2009},
      {{1000, K::kStale, 200}, ServoExit::kFault, SafetyFault::kSilence, 1009},
      {{1000, K::kShortPacket, 1}, ServoExit::kEnd, SafetyFault::kNone, 2000},
      {{1000, K::kShortPacket, 200}, ServoExit::kFault, SafetyFault::kSilence, 1009},
      {{1000, K::kTimeout, 1}, ServoExit::kTimeout, SafetyFault::kDevice, 1000},
      {{1000, K::kUnplug, 1}, ServoExit::kDisconnected, SafetyFault::kDevice, 1000},
      {{0, K::kUnplug, 1}, ServoExit::kDisconnected, SafetyFault::kDevice, 0},
      {{1000, K::kNan, 1}, ServoExit::kEnd, SafetyFault::kNone, 2000},
      {{1000, K::kNan, 3}, ServoExit::kFault, SafetyFault::kNotFinite, 1003},
      {{1000, K::kJump, 1}, ServoExit::kEnd, SafetyFault::kNone, 2000},
      {{1000, K::kJump, 3}, ServoExit::kFault, SafetyFault::kJump, 1002},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(::testing::Message() << static_cast<int>(c.fault.kind) << " x" << c.fault.count);
    const Played run = play({c.fault});
    EXPECT_EQ(run.report.exit, c.exit);
    EXPECT_EQ(run.report.fault, c.why);
    EXPECT_EQ(run.report.ticks, c.ticks);
    EXPECT_EQ(run.left, Vec3(0.0));
    for (const double force : run.forces) ASSERT_LE(force, 1.0 + 1e-12);
    EXPECT_EQ(run.report.state,
              run.report.fault == SafetyFault::kNone ? SafetyState::kActive : SafetyState::kFault);
  }
}

TEST(ReplayDevice, AfterSilenceAndAfterANanTheForceGrowsFromZero) {
  const Played silent = play({{1000, InjectedKind::kStale, 50}});
  EXPECT_EQ(silent.forces[1009], 0.0);
  EXPECT_NEAR(silent.forces[1009 + 250], 0.5, 1e-9);
  const Played nan = play({{1000, InjectedKind::kNan, 1}});
  EXPECT_EQ(nan.forces[1000], 0.0);
  EXPECT_EQ(nan.forces[1001], 0.0);
  EXPECT_NEAR(nan.forces[1001 + 250], 0.5, 1e-9);
}

TEST(ReplayDevice, AfterAnUnpluggingItMustBeOpenedAndTheRampBeginsAnew) {
  ReplayDevice device(rows(), hand(), {{1000, InjectedKind::kUnplug, 1}});
  DeviceState state;
  device.open();
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(device.read(state), DeviceStatus::kOk);
  EXPECT_EQ(device.read(state), DeviceStatus::kDisconnected);
  EXPECT_EQ(device.read(state), DeviceStatus::kDisconnected);
  EXPECT_EQ(device.write(kPush), DeviceStatus::kDisconnected);
  device.open();
  EXPECT_EQ(device.read(state), DeviceStatus::kOk);
}

TEST(ReplayDevice, NoRowsAreRefused) {
  EXPECT_EQ(errorOf([] { ReplayDevice(std::vector<DeviceState>(), {}); }).problem().code,
            "record.empty");
}

}  // namespace
}  // namespace palpate::devices
