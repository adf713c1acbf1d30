// The driver of input devices through the C library's open(), ioctl() and read(), which umockdev
// answers like the kernel.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>
#include <memory>
#include <string>

#include "node.h"
#include "palpate/devices/device.h"
#include "palpate/devices/evdev.h"
#include "support/alloc_guard.h"
#include "support/error_of.h"
#include "support/wait.h"

namespace palpate::devices {
namespace {

using testing::Node;
using testing::Testbed;

/// [ns] of the monotonic clock; whole microseconds, as events have.
std::int64_t clockNow() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1'000 + 1) * 1'000;
}

constexpr std::int64_t kMilli = 1'000'000;  // [ns]
constexpr double kRounding = 1e-12;         // [m]

void makeMouse(Node& node) {
  node.name = "Mock Mouse";
  for (const int key : {BTN_LEFT, BTN_RIGHT}) node.has_keys.set(static_cast<std::size_t>(key));
  for (const int axis : {REL_X, REL_Y, REL_WHEEL}) {
    node.has_relative.set(static_cast<std::size_t>(axis));
  }
}

void makeSpaceMouse(Node& node) {
  node.name = "Mock SpaceMouse";
  node.has_keys.set(BTN_0);
  for (const int axis : {REL_X, REL_Y, REL_Z, REL_RX, REL_RY, REL_RZ}) {
    node.has_relative.set(static_cast<std::size_t>(axis));
  }
}

void makeGamepad(Node& node) {
  node.name = "Mock Pad";
  for (const int key : {BTN_SOUTH, BTN_EAST}) node.has_keys.set(static_cast<std::size_t>(key));
  for (const int axis : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) {
    node.absolute[axis] = {
        .value = 0, .minimum = -1000, .maximum = 1000, .fuzz = 0, .flat = 0, .resolution = 0};
  }
}

class EvdevNode : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(umockdev_in_mock_environment())
        << "libumockdev-preload.so.0 must be loaded first: LD_PRELOAD, as ctest sets it";
  }
  Testbed bed_;
};

TEST_F(EvdevNode, AllNodesAreListedAndTheBestOneIsOpened) {
  Node mouse(bed_, 10);
  Node keyboard(bed_, 2);
  Node pad(bed_, 3);
  makeMouse(mouse);
  makeGamepad(pad);
  keyboard.name = "Mock Keyboard";
  keyboard.has_keys.set(KEY_A);
  const auto list = listInputDevices();
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].node, "/dev/input/event2");
  EXPECT_FALSE(list[0].kind);
  EXPECT_EQ(list[1].name, "Mock Pad");
  EXPECT_EQ(list[1].kind, InputKind::kGamepad);
  EXPECT_EQ(list[2].node, "/dev/input/event10");
  EXPECT_EQ(list[2].kind, InputKind::kMouse);
  for (const InputDevice& each : list) EXPECT_TRUE(each.is_accessible);

  const auto device = makeEvdev({});
  device->open();
  EXPECT_EQ(device->info().name, "evdev, gamepad: Mock Pad");
  EXPECT_EQ(device->info().buttons, 2);
  EXPECT_EQ(device->info().max_force, 0.0);
  EXPECT_EQ(pad.clock(), CLOCK_MONOTONIC);
  device->close();
  device->close();
  DeviceState state;
  EXPECT_EQ(device->read(state), DeviceStatus::kDisconnected);

  Node space(bed_, 11);
  makeSpaceMouse(space);
  device->open();
  EXPECT_EQ(device->info().name, "evdev, SpaceMouse: Mock SpaceMouse");
}

TEST_F(EvdevNode, ANodeIsOpenedByItsNameOrRefusedWithARemedy) {
  Node mouse(bed_, 0);
  Node keyboard(bed_, 1);
  makeMouse(mouse);
  keyboard.has_keys.set(KEY_A);
  const auto device = makeEvdev({.node = mouse.path()});
  device->open();
  EXPECT_EQ(device->info().name, "evdev, mouse: Mock Mouse");
  const auto other = makeEvdev({.node = keyboard.path()});
  const Error error = errorOf([&] { other->open(); });
  EXPECT_EQ(error.kind(), ErrorKind::kDevice);
  EXPECT_EQ(error.problem().code, "evdev.kind");
}

TEST_F(EvdevNode, AProgramWithoutInputOpensItAsDescriptorZero) {
  Node mouse(bed_, 0);
  makeMouse(mouse);
  const auto device = makeEvdev({.node = mouse.path()});
  const int input = dup(0);
  ::close(0);
  std::string refusal;
  try {
    device->open();
  } catch (const Error& error) {
    refusal = error.problem().code;
  }
  device->close();
  if (input >= 0) {
    dup2(input, 0);
    ::close(input);
  }
  EXPECT_EQ(refusal, "");
}

TEST_F(EvdevNode, WithoutOneThatFitsItSaysSo) {
  Node keyboard(bed_, 1);
  keyboard.has_keys.set(KEY_A);
  const auto device = makeEvdev({});
  const Error error = errorOf([&] { device->open(); });
  EXPECT_EQ(error.kind(), ErrorKind::kDevice);
  EXPECT_EQ(error.problem().code, "evdev.none");
}

TEST_F(EvdevNode, AccessThatIsDeniedIsSaidWithItsRemedy) {
  Node mouse(bed_, 0);
  makeMouse(mouse);
  char* const folder = umockdev_testbed_get_root_dir(bed_.get());
  const std::string root = folder;
  g_free(folder);
  ASSERT_EQ(chmod(root.c_str(), 0755), 0);
  // umockdev's own socket stays accessible to everybody; this test denies access to the device
  // only.
  ASSERT_EQ(chmod((root + "/ioctl" + mouse.path()).c_str(), 0777), 0);
  ASSERT_EQ(chmod((root + mouse.path()).c_str(), 0), 0);
  const uid_t self = geteuid();
  constexpr uid_t kNobody = 65534;
  if (self == 0) {
    ASSERT_EQ(seteuid(kNobody), 0);  // root could open everything
  }
  const auto list = listInputDevices();
  std::vector<Error> errors;
  for (const std::string& node : {std::string(), mouse.path()}) {
    errors.push_back(errorOf([&] { makeEvdev({.node = node})->open(); }));
  }
  ASSERT_EQ(seteuid(self), 0);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_FALSE(list[0].is_accessible);
  EXPECT_FALSE(list[0].kind);
  for (const Error& error : errors) {
    EXPECT_EQ(error.kind(), ErrorKind::kDevice);
    EXPECT_EQ(error.problem().code, "evdev.access");
    EXPECT_EQ(error.problem().hint, inputAccessRemedy());
  }
}

TEST_F(EvdevNode, EventsCountFromTheTimeThatTheKernelGivesThem) {
  Node pad(bed_, 0);
  makeGamepad(pad);
  const auto device = makeEvdev({.max_speed = 0.1, .dead_zone = 0.0});
  device->open();
  DeviceState state;
  ASSERT_EQ(device->read(state), DeviceStatus::kOk);
  const std::int64_t begin = clockNow();
  pad.report(begin, {{EV_ABS, ABS_X, 1000}, {EV_KEY, BTN_EAST, 1}});
  pad.report(begin + 2 * kMilli, {{EV_ABS, ABS_X, -500}});
  pad.report(begin + 4 * kMilli, {{EV_ABS, ABS_X, 0}});
  ASSERT_TRUE(testing::waitUntil([&] { return clockNow() > begin + 4 * kMilli; }));
  ASSERT_EQ(device->read(state), DeviceStatus::kOk);
  EXPECT_NEAR(state.position.x, 2e-4 - 1e-4, kRounding);
  EXPECT_EQ(state.buttons, 2U);
  EXPECT_TRUE(state.is_homed);
  EXPECT_EQ(device->write(Vec3(1.0)), DeviceStatus::kOk);
}

TEST_F(EvdevNode, AKernelThatRefusesTheClockLeavesTheTimeOfTheReading) {
  Node mouse(bed_, 0);
  makeMouse(mouse);
  mouse.refuses_clock = true;
  const auto device = makeEvdev({.meters_per_count = 1e-4});
  device->open();
  EXPECT_EQ(mouse.clock(), -1);
  mouse.report(1'700'000'000'000'000'000, {{EV_REL, REL_X, 50}});  // in wall-clock time
  DeviceState state;
  ASSERT_EQ(device->read(state), DeviceStatus::kOk);
  EXPECT_NEAR(state.position.x, 5e-3, kRounding);
  // The time of the first reading since open()
  EXPECT_NEAR(state.velocity.x * state.time, 5e-3, kRounding);
}

TEST_F(EvdevNode, AStickThatIsHeldWhenItIsOpenedMoves) {
  Node pad(bed_, 0);
  makeGamepad(pad);
  pad.absolute[ABS_Y].value = 1000;
  pad.keys.set(BTN_SOUTH);
  const auto device = makeEvdev({.max_speed = 0.1});
  device->open();
  DeviceState state;
  ASSERT_EQ(device->read(state), DeviceStatus::kOk);
  EXPECT_EQ(state.buttons, 1U);
  EXPECT_NEAR(state.position.z, 0.1 * state.time, kRounding);
}

TEST_F(EvdevNode, AfterLostEventsItAsksWhatTheDeviceIsAt) {
  Node pad(bed_, 0);
  makeGamepad(pad);
  const auto device = makeEvdev({.max_speed = 0.1});
  device->open();
  DeviceState before;
  ASSERT_EQ(device->read(before), DeviceStatus::kOk);
  EXPECT_EQ(before.position, Vec3(0.0));
  pad.keys.set(BTN_EAST);
  pad.absolute[ABS_X].value = -1000;
  pad.report(clockNow(), {{EV_KEY, BTN_SOUTH, 1}, {EV_SYN, SYN_DROPPED, 0}, {EV_ABS, ABS_Y, 9}});
  DeviceState state;
  ASSERT_EQ(device->read(state), DeviceStatus::kOk);
  EXPECT_EQ(state.buttons, 2U);
  DeviceState next;
  ASSERT_EQ(device->read(next), DeviceStatus::kOk);
  EXPECT_NEAR(next.position.x - state.position.x, -0.1 * (next.time - state.time), kRounding);
  EXPECT_EQ(next.position.z, 0.0);
}

TEST_F(EvdevNode, MoreEventsThanOneReadTakesAllCount) {
  Node mouse(bed_, 0);
  makeMouse(mouse);
  const auto device = makeEvdev({.meters_per_count = 1e-5});
  device->open();
  const std::int64_t now = clockNow();
  for (int i = 0; i < 500; ++i) mouse.report(now, {{EV_REL, REL_Y, 3}});
  DeviceState state;
  const testing::AllocGuard guard;
  const DeviceStatus status = device->read(state);
  const testing::AllocGuard::Counts counts = guard.counts();
  ASSERT_EQ(status, DeviceStatus::kOk);
  EXPECT_NEAR(state.position.z, 0.015, kRounding);
  // umockdev takes a lock in each call, so locks are not counted here.
  EXPECT_EQ(counts.allocations + counts.releases + counts.throws, 0);
}

TEST_F(EvdevNode, UnpluggedAtAnyCallOfOpenItIsADeviceError) {
  Node pad(bed_, 0);
  makeGamepad(pad);
  int calls = 0;
  for (bool is_open = false; !is_open; ++calls) {
    ASSERT_LT(calls, 50);
    pad.unplugAfter(calls);
    const auto device = makeEvdev({.node = pad.path()});
    try {
      device->open();
      is_open = true;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kDevice);
      EXPECT_FALSE(error.problem().hint.empty());
    }
  }
  EXPECT_GT(calls, 10);  // capabilities, ranges, clock, keys and values
}

TEST_F(EvdevNode, UnpluggedInUseItSaysSoUntilItIsOpenedAgain) {
  const auto device = makeEvdev({});
  DeviceState state;
  {
    Node mouse(bed_, 0);
    makeMouse(mouse);
    device->open();
    ASSERT_EQ(device->read(state), DeviceStatus::kOk);
    mouse.unplug();
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(device->read(state), DeviceStatus::kDisconnected);
      EXPECT_EQ(device->write(Vec3(0.0)), DeviceStatus::kDisconnected);
    }
    EXPECT_EQ(errorOf([&] { device->open(); }).kind(), ErrorKind::kDevice);
  }
  Node again(bed_, 1);
  makeMouse(again);
  again.report(clockNow(), {{EV_REL, REL_X, 1}});
  device->open();
  EXPECT_EQ(device->read(state), DeviceStatus::kOk);
}

TEST_F(EvdevNode, TheLoopTicksItAndWritesNoForce) {
  Node mouse(bed_, 0);
  makeMouse(mouse);
  const auto device = makeEvdev({.meters_per_count = 1e-4});
  int ticks = 0;
  double furthest = 0.0;
  const auto tick = [&](const DeviceState& state) {
    furthest = state.position.x;
    mouse.report(clockNow(), {{EV_REL, REL_X, 1}});
    if (++ticks == 100) mouse.unplug();
    return Vec3(0.0, 0.0, 5.0);
  };
  bool is_felt = false;
  const auto observe = [&](const ServoTurn& turn) { is_felt |= turn.written != Vec3(0.0); };
  const std::atomic<bool> stop{false};
  const ServoReport report = runServo(*device, tick, {}, stop, observe);
  EXPECT_EQ(report.exit, ServoExit::kDisconnected);
  EXPECT_EQ(report.ticks, 100U);
  EXPECT_NEAR(furthest, 99e-4, kRounding);
  EXPECT_FALSE(is_felt);
}

}  // namespace
}  // namespace palpate::devices
