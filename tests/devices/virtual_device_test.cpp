#include <gtest/gtest.h>

#include "palpate/core/error.h"
#include "palpate/devices/path.h"

namespace palpate::devices {
namespace {

const Path kThree{{1.0, Vec3(0.0)}, {1.5, Vec3(1.0, 2.0, 3.0)}, {1.75, Vec3(1.0, 0.0, 3.5)}};

TEST(VirtualDevice, PlaysOneRowARead) {
  VirtualDevice device(kThree);
  device.open();
  DeviceState state;
  for (const PathPoint& point : kThree) {
    ASSERT_EQ(device.read(state), DeviceStatus::kOk);
    EXPECT_EQ(state.time, point.t);
    EXPECT_EQ(state.position, point.position);
  }
  EXPECT_EQ(device.read(state), DeviceStatus::kEnd);
  EXPECT_EQ(device.read(state), DeviceStatus::kEnd);
  EXPECT_EQ(state.position, kThree.back().position);
}

TEST(VirtualDevice, VelocityIsTheBackwardDifferenceAndZeroFirst) {
  VirtualDevice device(kThree);
  device.open();
  DeviceState state;
  ASSERT_EQ(device.read(state), DeviceStatus::kOk);
  EXPECT_EQ(state.velocity, Vec3(0.0));
  ASSERT_EQ(device.read(state), DeviceStatus::kOk);
  EXPECT_EQ(state.velocity, Vec3(2.0, 4.0, 6.0));
  ASSERT_EQ(device.read(state), DeviceStatus::kOk);
  EXPECT_EQ(state.velocity, Vec3(0.0, -8.0, 2.0));
}

TEST(VirtualDevice, OpeningAgainStartsAnew) {
  VirtualDevice device(kThree);
  DeviceState state;
  for (int run = 0; run < 2; ++run) {
    device.open();
    EXPECT_EQ(device.lastForce(), Vec3(0.0));
    ASSERT_EQ(device.read(state), DeviceStatus::kOk);
    EXPECT_EQ(state.time, 1.0);
    EXPECT_EQ(state.velocity, Vec3(0.0));
    ASSERT_EQ(device.read(state), DeviceStatus::kOk);
    EXPECT_EQ(device.write(Vec3(1.0, 0.0, 0.0)), DeviceStatus::kOk);
    EXPECT_EQ(device.lastForce(), Vec3(1.0, 0.0, 0.0));
    device.close();
    EXPECT_EQ(device.lastForce(), Vec3(0.0));
    device.close();
  }
}

TEST(VirtualDevice, AnswersDisconnectedWhileClosed) {
  VirtualDevice device(kThree);
  DeviceState state;
  EXPECT_EQ(device.read(state), DeviceStatus::kDisconnected);
  EXPECT_EQ(device.write(Vec3(1.0)), DeviceStatus::kDisconnected);
  EXPECT_EQ(device.lastForce(), Vec3(0.0));
}

TEST(VirtualDevice, ItsWorkspaceIsTheBoxOfThePath) {
  const VirtualDevice device(kThree);
  EXPECT_EQ(device.info().name, "virtual");
  EXPECT_EQ(device.info().workspace.lo, Vec3(0.0));
  EXPECT_EQ(device.info().workspace.hi, Vec3(1.0, 2.0, 3.5));
}

TEST(VirtualDevice, RefusesAnEmptyPathAndTimesThatDoNotRise) {
  EXPECT_THROW(VirtualDevice({}), Error);
  EXPECT_THROW(VirtualDevice({{0.0, Vec3(0.0)}, {0.0, Vec3(0.0)}}), Error);
  EXPECT_THROW(VirtualDevice({{0.0, Vec3(0.0)}, {-1.0, Vec3(0.0)}}), Error);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(VirtualDevice({{nan, Vec3(0.0)}}), Error);
  EXPECT_THROW(VirtualDevice({{0.0, Vec3(0.0)}, {nan, Vec3(0.0)}}), Error);
}

}  // namespace
}  // namespace palpate::devices
