#pragma once
// A driver with an emulated Falcon, through the usual libusb.

#include <utility>
#include <vector>

#include "devices/falcon_emulator.h"
#include "devices/usbfs_emulation.h"
#include "falcon/falcon_device.h"

namespace palpate::devices {

/// The driver runs in the emulated device's time.
struct Rig {
  FalconEmulator emulator;
  UsbfsEmulation usb{emulator};
  falcon::FalconDevice device;

  explicit Rig(std::vector<std::uint8_t> firmware = {}, const FalconCalibration& c = {})
      : device([this] { return usb::openUsb({.descriptor = usb.descriptor()}); },
               std::move(firmware), c, [this] { return emulator.now(); }) {}

  /// Reads and writes until a reading comes; returns its status.
  DeviceStatus turn(DeviceState& state, const Vec3& force = Vec3(0.0)) {
    DeviceStatus status = DeviceStatus::kStale;
    for (int i = 0; i < 10 && status == DeviceStatus::kStale; ++i) {
      status = device.read(state);
      if (device.write(force) != DeviceStatus::kOk) return DeviceStatus::kDisconnected;
    }
    return status;
  }
};

}  // namespace palpate::devices
