#pragma once
/// The Novint Falcon, through libusb. Protocol from public sources, unverified on hardware.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "palpate/devices/device.h"
#include "palpate/export.h"

namespace palpate::devices {

/// The USB vendor id that a Falcon reports: that of its chip's maker, FTDI.
constexpr std::uint16_t kFalconVendor = 0x0403;
/// The USB product id that a Falcon reports.
constexpr std::uint16_t kFalconProduct = 0xcb48;

/// Numbers that differ from device to device, or that nobody has measured. In a file: one `name
/// value` a line; '#' begins a comment.
struct FalconCalibration {
  /// [counts/Nm] of a motor's command per torque at the thigh; from libnifalcon, never measured:
  /// the real force may be wrong by a factor of two or three. Negative: the command that turns an
  /// arm outward.
  double counts_per_torque = -10000.0;
  double radians_per_count = 0.000635905;  ///< [rad] angle of a thigh per encoder count
  Vec3 zero_angles{0.610865, 0.610865,
                   0.610865};  ///< [rad] angle of the thighs where the encoders read 0: 35 degrees
  Vec3 origin{0.0, 0.0, 0.125};   ///< [m] origin of the device's frame, in the frame of its base
  double max_force = 8.0;         ///< [N] the largest that is asked of the motors
  double continuous_force = 4.0;  ///< [N] that they can hold forever: assumed, none is published
};

/// @throws Error (kInput) if the file cannot be read, a name is unknown or a value is out of range.
[[nodiscard]] PALPATE_EXPORT FalconCalibration readFalconCalibration(const std::string& file);
/// The text of a file that readFalconCalibration() reads back exactly.
[[nodiscard]] PALPATE_EXPORT std::string textOf(const FalconCalibration& calibration);

/// The choice of a Falcon and its constants.
struct FalconSettings {
  std::string serial;  ///< empty: the first one
  /// 0 or more: an open file descriptor of its node. After that, libusb no longer finds devices by
  /// itself in this process.
  int descriptor = -1;
  std::string firmware;  ///< image for a device that runs none; empty: such a device is refused
  FalconCalibration calibration = {};  ///< the defaults unless a file was read
};

/// The device's frame: x to the right, y up, z towards the hand, from FalconCalibration::origin.
/// Its buttons: 1 plus, 2 forward, 4 center, 8 minus. DeviceState::velocity is the backward
/// difference of the positions. It replies once to each command, so it is the loop's clock (about 1
/// kHz). Until its encoders are homed (pull the grip out, then push it in) it gets zero force.
/// libusb allocates a block of memory for each transfer.
[[nodiscard]] PALPATE_EXPORT std::unique_ptr<Device> makeFalcon(const FalconSettings& settings);

}  // namespace palpate::devices
