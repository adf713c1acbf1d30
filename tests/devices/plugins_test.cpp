// Drivers for makers' libraries, tested with small fake libraries.

#include "palpate/devices/plugins.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "folders/folders.h"
#include "support/error_of.h"

namespace palpate::devices {
namespace {

std::string fakeLibrary(const std::string& name) {
  return test::buildFolder() + "/tests/libpalpate_fake_" + name + ".so";
}

/// Same layout as in tests/fakes/fake_hd.cpp.
struct FakeHd {
  std::array<double, 3> position_mm;
  std::array<double, 3> velocity_mm;
  std::array<double, 3> force;
  int buttons;
  unsigned error;
  int is_absent, is_running, is_open, force_is_enabled, frames, torn_frames;
};

/// Same layout as in tests/fakes/fake_dhd.cpp.
struct FakeDhd {
  std::array<double, 3> position;
  std::array<double, 3> velocity;
  std::array<double, 3> force;
  int button, answer, set_answer, is_absent, is_open, force_is_enabled;
};

/// Access to the fake library, so that a test can inspect it before and after the driver.
template <typename State>
class Fake {
 public:
  explicit Fake(const std::string& file) : handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    state_ = reinterpret_cast<State* (*)()>(dlsym(handle_, "fakeState"))();
    *state_ = {};
  }
  ~Fake() { dlclose(handle_); }
  Fake(const Fake&) = delete;
  Fake& operator=(const Fake&) = delete;
  State* operator->() const { return state_; }
  void turn() const { reinterpret_cast<void (*)()>(dlsym(handle_, "fakeTurn"))(); }

 private:
  void* handle_;
  State* state_;
};

TEST(OpenHaptics, WithoutTheLibraryItSaysWhatToInstall) {
  const auto device = makeOpenHaptics({"libno_such_haptics.so"});
  const Error error = errorOf([&] { device->open(); });
  EXPECT_EQ(error.kind(), ErrorKind::kDevice);
  EXPECT_EQ(error.problem().code, "device.library");
  EXPECT_NE(error.problem().message.find("libno_such_haptics.so"), std::string::npos);
  EXPECT_NE(error.problem().hint.find("OpenHaptics"), std::string::npos);
  DeviceState state;
  EXPECT_EQ(device->read(state), DeviceStatus::kDisconnected);
}

TEST(OpenHaptics, AnotherLibraryIsRefusedByTheFunctionThatItLacks) {
  const auto device = makeOpenHaptics({fakeLibrary("dhd")});
  const Error error = errorOf([&] { device->open(); });
  EXPECT_EQ(error.problem().code, "device.library");
  EXPECT_NE(error.problem().message.find("hdInitDevice"), std::string::npos);
}

TEST(OpenHaptics, ReadsMillimetersAndWritesNewtons) {
  const Fake<FakeHd> fake(fakeLibrary("hd"));
  const auto device = makeOpenHaptics({fakeLibrary("hd")});
  device->open();
  EXPECT_EQ(fake->is_running, 1);
  EXPECT_EQ(fake->force_is_enabled, 1);
  EXPECT_DOUBLE_EQ(device->info().max_force, 3.3);
  EXPECT_DOUBLE_EQ(device->info().limits.continuous_force, 0.88);
  DeviceState state;
  EXPECT_EQ(device->read(state), DeviceStatus::kStale) << "before the first turn";
  fake->position_mm = {1.0, -20.0, 300.0};
  fake->velocity_mm = {4.0, 5.0, -6.0};
  fake->buttons = 2;
  fake.turn();
  ASSERT_EQ(device->read(state), DeviceStatus::kOk);
  EXPECT_NEAR(glm::length(state.position - Vec3(1e-3, -2e-2, 0.3)), 0.0, 1e-15);
  EXPECT_NEAR(glm::length(state.velocity - Vec3(4e-3, 5e-3, -6e-3)), 0.0, 1e-15);
  EXPECT_EQ(state.buttons, 2U);
  EXPECT_EQ(state.orientation * Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0));
  EXPECT_EQ(device->read(state), DeviceStatus::kStale) << "the same turn again";
  ASSERT_EQ(device->write(Vec3(1.0, 2.0, -3.0)), DeviceStatus::kOk);
  fake.turn();
  EXPECT_EQ(fake->force, (std::array<double, 3>{1.0, 2.0, -3.0}));
  EXPECT_EQ(fake->torn_frames, 0);
  device->close();
  EXPECT_EQ(fake->force, (std::array<double, 3>{}));
  EXPECT_EQ(fake->is_running, 0);
  EXPECT_EQ(fake->is_open, 0);
  EXPECT_EQ(fake->torn_frames, 0);
}

TEST(OpenHaptics, ItsThreadLetsGoWhenNobodyWrites) {
  const Fake<FakeHd> fake(fakeLibrary("hd"));
  const auto device = makeOpenHaptics({fakeLibrary("hd")});
  device->open();
  (void)device->write(Vec3(1.0, 0.0, 0.0));
  for (int turn = 0; turn < 40; ++turn) {
    fake.turn();
    ASSERT_EQ(fake->force[0], turn < 20 ? 1.0 : 0.0) << turn;
  }
  (void)device->write(Vec3(2.0, 0.0, 0.0));
  fake.turn();
  EXPECT_EQ(fake->force[0], 2.0);
}

TEST(OpenHaptics, AnErrorOfTheLibraryIsAFaultAndAnAbsentDeviceIsTold) {
  const Fake<FakeHd> fake(fakeLibrary("hd"));
  const auto device = makeOpenHaptics({fakeLibrary("hd")});
  fake->is_absent = 1;
  EXPECT_EQ(errorOf([&] { device->open(); }).problem().code, "device.none");
  fake->is_absent = 0;
  device->open();
  fake->error = 0x0302;
  fake.turn();
  DeviceState state;
  EXPECT_EQ(device->read(state), DeviceStatus::kFault);
  EXPECT_EQ(device->read(state), DeviceStatus::kFault) << "until it is opened again";
}

TEST(Plugins, ALibraryThatIsThereIsFoundAndNoneIsNot) {
  EXPECT_TRUE(hasOpenHaptics({fakeLibrary("hd")}));
  EXPECT_TRUE(hasForceDimension({fakeLibrary("dhd")}));
  EXPECT_FALSE(hasOpenHaptics({"libno_such_haptics.so"}));
  EXPECT_FALSE(hasForceDimension({"libno_such_haptics.so"}));
}

TEST(ForceDimension, ReadsWritesAndLetsGo) {
  const Fake<FakeDhd> fake(fakeLibrary("dhd"));
  const auto device = makeForceDimension({fakeLibrary("dhd")});
  device->open();
  EXPECT_EQ(device->info().name, "omega.3");
  fake->position = {0.01, 0.02, -0.03};
  fake->velocity = {0.1, 0.2, 0.3};
  fake->button = 1;
  DeviceState state;
  ASSERT_EQ(device->read(state), DeviceStatus::kOk);
  EXPECT_EQ(state.position, Vec3(0.01, 0.02, -0.03));
  EXPECT_EQ(state.velocity, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(state.buttons, 1U);
  ASSERT_EQ(device->write(Vec3(1.0, 2.0, 3.0)), DeviceStatus::kOk);
  EXPECT_EQ(fake->force, (std::array<double, 3>{1.0, 2.0, 3.0}));
  device->cut();
  EXPECT_EQ(fake->force, (std::array<double, 3>{}));
  fake->set_answer = 2;  // saturated
  EXPECT_EQ(device->write(Vec3(50.0)), DeviceStatus::kOk);
  fake->set_answer = -1;
  EXPECT_EQ(device->write(Vec3(1.0)), DeviceStatus::kFault);
  fake->answer = 1;
  EXPECT_EQ(device->read(state), DeviceStatus::kStale);
  fake->answer = -1;
  EXPECT_EQ(device->read(state), DeviceStatus::kFault);
  device->close();
  EXPECT_EQ(fake->force, (std::array<double, 3>{}));
  EXPECT_EQ(fake->is_open, 0);
  EXPECT_EQ(fake->force_is_enabled, 0);
}

TEST(ForceDimension, AnAbsentDeviceIsToldInTheLibrarysWords) {
  const Fake<FakeDhd> fake(fakeLibrary("dhd"));
  fake->is_absent = 1;
  const auto device = makeForceDimension({fakeLibrary("dhd")});
  const Error error = errorOf([&] { device->open(); });
  EXPECT_EQ(error.problem().code, "device.none");
  EXPECT_NE(error.problem().message.find("no device found"), std::string::npos);
}

}  // namespace
}  // namespace palpate::devices
