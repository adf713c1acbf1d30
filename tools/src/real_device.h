#pragma once
/// Devices that a hand really holds, by their names for --device.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "options.h"
#include "palpate/devices/device.h"

namespace palpate::tools {

/// falcon, inverse3, dhd, hd, or evdev, which may be followed by its node: evdev:/dev/input/event5.
[[nodiscard]] bool isRealDevice(std::string_view name);

/// An input device, which has no motors.
[[nodiscard]] bool isInputDevice(std::string_view name);

/// A notice that must appear wherever the device `name` is offered or used.
[[nodiscard]] const char* noticeOf(std::string_view name);

/// The first option that is given, such as "--serial"; empty: none.
[[nodiscard]] std::string givenOption(const RealDeviceOptions& options);

/// Does not open the device yet. `seconds` [s] after the device is opened it reports its end; if
/// not given, it never does.
/// @throws Error: kUsage for options that the device does not have, kInput for its files, kDevice
/// if this build has no driver for it.
[[nodiscard]] std::unique_ptr<devices::Device> makeRealDevice(const std::string& name,
                                                              const RealDeviceOptions& options,
                                                              std::optional<double> seconds);

}  // namespace palpate::tools
