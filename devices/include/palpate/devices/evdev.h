#pragma once
/// A hand without a haptic device: a SpaceMouse, a gamepad or a mouse moves the probe, through the
/// kernel's input devices (evdev). The force is shown, not felt.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/devices/device.h"
#include "palpate/export.h"

namespace palpate::devices {

/// True of every input device; used instead of kUnverifiedNotice.
constexpr const char* kEvdevNotice = "force is shown, not felt; unverified on hardware";

/// Kinds of input devices, in the order in which makeEvdev() prefers them.
enum class InputKind : std::uint8_t {
  kSpaceMouse,  ///< six axes: its cap's deflection is a velocity and an angular velocity
  kGamepad,     ///< its sticks' and triggers' deflections are velocities
  kMouse,       ///< counts are a distance; the wheel lifts
};
/// "SpaceMouse", "gamepad" or "mouse".
[[nodiscard]] PALPATE_EXPORT std::string_view nameOf(InputKind kind) noexcept;

/// The settings of makeEvdev().
struct EvdevSettings {
  std::string node = {};   ///< such as /dev/input/event5; empty: the first that fits, by InputKind
  double max_speed = 0.1;  ///< [m/s] along each axis, at full deflection
  double max_turn = 1.0;   ///< [rad/s] about each axis, at full deflection
  double dead_zone = 0.1;  ///< [-] share of full deflection that has no effect; 0 to below 1
  double meters_per_count =
      25.4e-6;  ///< [m] per count of a mouse; the default is that of 1000 counts an inch
  double meters_per_notch = 1e-3;  ///< [m] per notch of a mouse's wheel
  Box3 workspace{Vec3(-0.1),
                 Vec3(0.1)};  ///< [m] the position begins in its middle, and never leaves it
};

/// The device's frame: x to the right, y up, z towards the hand. A gamepad's left stick moves in
/// the plane x, z; the right one up and down, and turns about y; the triggers lift (right) and
/// lower (left).
///
/// The position is the integral of the velocities over the kernel's time of each event, and over
/// the time of read() since the last one. A SpaceMouse for which the kernel reports relative axes
/// is at rest when it is silent, because the kernel drops its zeros. DeviceState::velocity is the
/// backward difference of the positions. Bit i of the buttons is the i-th button by its code.
/// DeviceInfo::max_force is 0: it has no motors, and write() does nothing. Other programs still
/// receive the events, too.
///
/// open() throws Error (kDevice) where no such device is plugged in, or access is denied. Once it
/// is unplugged, read() and write() answer kDisconnected.
/// @throws Error (kUsage) for settings that are out of range.
[[nodiscard]] PALPATE_EXPORT std::unique_ptr<Device> makeEvdev(const EvdevSettings& settings);

/// A node of /dev/input.
struct InputDevice {
  std::string node;               ///< /dev/input/event5
  std::string name;               ///< its own name; empty: no access
  std::optional<InputKind> kind;  ///< no value: it does not fit, or there is no access
  bool is_accessible = false;     ///< this user may open it
};

/// All event nodes, by their number.
[[nodiscard]] PALPATE_EXPORT std::vector<InputDevice> listInputDevices();

/// The remedy for a user who is not permitted to open input devices, as a text.
[[nodiscard]] PALPATE_EXPORT std::string inputAccessRemedy();

}  // namespace palpate::devices
