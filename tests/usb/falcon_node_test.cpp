// A Falcon that libusb's own search finds, and that is opened, unplugged and plugged in again:
// umockdev emulates sysfs, udev and the device's node, and our emulation the kernel behind the
// node.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>

#include "devices/falcon_emulator.h"
#include "devices/usbfs_emulation.h"
#include "palpate/devices/device.h"
#include "palpate/devices/falcon.h"
#include "palpate/devices/usb_devices.h"
#include "support/error_of.h"

namespace palpate::devices {
namespace {

/// Descriptors of device, configuration and interface with bulk IN 0x81 and bulk OUT 0x02: those of
/// a Falcon, and of another manufacturer's device.
constexpr const char* kFalcon =
    "12010002000000400304 48CB 0006 010203 01"
    "09022000010100803209040000 02FFFFFF 0007058102400000 07050202400000";
constexpr const char* kOther =
    "12010002000000406D04 1CC3 0006 010203 01"
    "09022000010100803209040000 02FFFFFF 0007058102400000 07050202400000";

class FalconNode : public ::testing::Test {
 protected:
  FalconNode() : bed_(umockdev_testbed_new()) {
    usb_.serial = "FA1C0N";
    plugIn("other", 3, kOther);
  }
  ~FalconNode() override { g_object_unref(bed_); }

  void SetUp() override {
    ASSERT_TRUE(umockdev_in_mock_environment())
        << "libumockdev-preload.so.0 must be loaded first: LD_PRELOAD, as ctest sets it";
  }

  [[nodiscard]] static std::string numbered(int address) {
    return "/dev/bus/usb/001/00" + std::to_string(address);
  }
  [[nodiscard]] std::string folder() const {
    char* const text = umockdev_testbed_get_root_dir(bed_);
    const std::string root = text;
    g_free(text);
    return root;
  }
  [[nodiscard]] std::string fileOf(int address) const { return folder() + numbered(address); }

  void plugIn(const std::string& name, int address, std::string descriptors) {
    descriptors.erase(std::remove(descriptors.begin(), descriptors.end(), ' '), descriptors.end());
    const std::string number = std::to_string(address);
    const std::string text =
        "P: /devices/" + name + number + "\nN: bus/usb/001/00" + number +
        "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: BUSNUM=001\nE: DEVNUM=00" + number +
        "\nE: DEVNAME=" + numbered(address) +
        "\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum=" + number +
        "\\n\nA: speed=12\\n\nH: descriptors=" + descriptors + "\n";
    GError* error = nullptr;
    EXPECT_TRUE(umockdev_testbed_add_from_string(bed_, text.c_str(), &error))
        << (error != nullptr ? error->message : "");
  }
  void plugInFalcon(int address) {
    plugIn("falcon", address, kFalcon);
    usb_.answerForNode(fileOf(address));
    usb_.plugIn();
  }
  void unplugFalcon(int address) {
    usb_.unplug();
    const std::string path = "/sys/devices/falcon" + std::to_string(address);
    umockdev_testbed_uevent(bed_, path.c_str(), "remove");
    umockdev_testbed_remove_device(bed_, path.c_str());
  }

  UMockdevTestbed* bed_;
  FalconEmulator emulator_;
  UsbfsEmulation usb_{emulator_};
};

TEST_F(FalconNode, TheListHasWhatIsPluggedIn) {
  ASSERT_EQ(listUsbDevices().size(), 1U);
  plugInFalcon(5);
  const auto list = listUsbDevices();
  ASSERT_EQ(list.size(), 2U);
  const auto& falcon = list[list[0].vendor == kFalconVendor ? 0 : 1];
  EXPECT_EQ(falcon.vendor, kFalconVendor);
  EXPECT_EQ(falcon.product, kFalconProduct);
  EXPECT_EQ(falcon.bus, 1);
  EXPECT_EQ(falcon.address, 5);
  EXPECT_EQ(falcon.serial, "FA1C0N");
  EXPECT_TRUE(falcon.is_accessible);
}

TEST_F(FalconNode, ItIsOpenedByItsNumbersAndByItsSerialNumber) {
  plugInFalcon(5);
  for (const char* serial : {"", "FA1C0N"}) {
    FalconSettings settings;
    settings.serial = serial;
    const auto device = makeFalcon(settings);
    device->open();
    DeviceState state;
    ASSERT_EQ(device->read(state), DeviceStatus::kStale) << "no command was sent yet";
    ASSERT_EQ(device->write(Vec3(0.0)), DeviceStatus::kOk);
    ASSERT_EQ(device->read(state), DeviceStatus::kOk);
    device->close();
    EXPECT_EQ(usb_.pending(), 0);
  }
  FalconSettings another;
  another.serial = "ANOTHER";
  const Error other = errorOf([&] { makeFalcon(another)->open(); });
  EXPECT_EQ(other.problem().code, "device.none");
  EXPECT_NE(std::string(other.what()).find("ANOTHER"), std::string::npos);
}

TEST_F(FalconNode, WithoutOneItSaysSo) {
  const Error error = errorOf([] { makeFalcon({})->open(); });
  EXPECT_EQ(error.kind(), ErrorKind::kDevice);
  EXPECT_EQ(error.problem().code, "device.none");
  EXPECT_NE(std::string(error.what()).find("0403:cb48"), std::string::npos);
}

TEST_F(FalconNode, AccessThatIsDeniedIsSaidWithItsRemedy) {
  plugInFalcon(5);
  const std::string root = folder();
  // libusb's hotplug monitor puts its socket there.
  ASSERT_EQ(chmod(root.c_str(), 0777), 0);
  // umockdev's own socket stays accessible to everybody; this test denies access to the device
  // only.
  ASSERT_EQ(chmod((root + "/ioctl/_default").c_str(), 0777), 0);
  ASSERT_EQ(chmod(fileOf(3).c_str(), 0666), 0);
  ASSERT_EQ(chmod(fileOf(5).c_str(), 0), 0);
  const uid_t self = geteuid();
  constexpr uid_t kNobody = 65534;
  if (self == 0) {
    ASSERT_EQ(seteuid(kNobody), 0);  // root could open everything
  }
  const auto list = listUsbDevices();
  const Error error = errorOf([] { makeFalcon({})->open(); });
  ASSERT_EQ(seteuid(self), 0);
  EXPECT_EQ(error.kind(), ErrorKind::kDevice);
  EXPECT_EQ(error.problem().code, "device.access");
  EXPECT_NE(error.problem().hint.find("udev"), std::string::npos);
  ASSERT_EQ(list.size(), 2U);
  for (const UsbDevice& each : list) {
    EXPECT_EQ(each.is_accessible, each.vendor != kFalconVendor);
    EXPECT_TRUE(each.serial.empty());
  }
}

TEST_F(FalconNode, UnpluggedItIsGoneAndPluggedInAgainElsewhereItIsHomedAndRampedAnew) {
  plugInFalcon(5);
  emulator_.mass = 1e9;
  const auto device = makeFalcon({});
  std::atomic<bool> stop{false};
  const auto push = [](const DeviceState&) { return Vec3(0.0, 0.0, 1.0); };
  usb_.fault = [this](UsbfsEmulation::Step) { return emulator_.commands >= 600 ? ENODEV : 0; };
  // Each turn counts as a millisecond: the ramp of half a second is over before the cable is
  // unplugged.
  const ServoReport first = runServo(*device, push, {}, stop);
  EXPECT_EQ(first.exit, ServoExit::kDisconnected);
  EXPECT_EQ(first.fault, SafetyFault::kDevice);
  EXPECT_GT(emulator_.moving_commands, 400U);
  EXPECT_EQ(usb_.pending(), 0);
  unplugFalcon(5);
  usb_.fault = nullptr;
  EXPECT_EQ(errorOf([&] { device->open(); }).problem().code, "device.none");
  EXPECT_EQ(listUsbDevices().size(), 1U);

  plugInFalcon(6);
  emulator_.homed = 0;
  emulator_.motors = {};
  std::vector<int> sizes;
  emulator_.damage = [&](std::vector<std::uint8_t>&) {
    const auto& m = emulator_.motors;
    sizes.push_back(std::max({std::abs(m[0]), std::abs(m[1]), std::abs(m[2])}));
    if (sizes.size() == 200) emulator_.homed = 7;
    if (sizes.size() == 800) stop = true;
  };
  const ServoReport second = runServo(*device, push, {}, stop);
  EXPECT_EQ(second.exit, ServoExit::kStopped);
  EXPECT_EQ(second.state, SafetyState::kActive);
  ASSERT_GE(sizes.size(), 800U);
  for (std::size_t i = 0; i <= 200; ++i) ASSERT_EQ(sizes[i], 0) << "not homed, " << i;
  for (std::size_t i = 200; i < 700; ++i) {
    ASSERT_LE(sizes[i], static_cast<double>(i - 200) / 500.0 * sizes[799] + 1.0) << i;
  }
  EXPECT_GT(sizes[799], 20);
}

}  // namespace
}  // namespace palpate::devices
