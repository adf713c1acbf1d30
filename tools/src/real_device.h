#pragma once
/// Devices that a hand really holds, by the name that --device gives them.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "options.h"
#include "palpate/devices/device.h"

namespace palpate::tools {

/// falcon, inverse3, dhd, hd, or evdev, which may have its node behind it: evdev:/dev/input/event5.
[[nodiscard]] bool isRealDevice(std::string_view name);

/// An input device, which has no motors.
[[nodiscard]] bool isInputDevice(std::string_view name);

/// What has to be said wherever the device `name` is offered or used.
[[nodiscard]] const char* noticeOf(std::string_view name);

/// The first option that is given, such as "--serial"; empty: none is.
[[nodiscard]] std::string givenOption(const RealDeviceOptions& options);

/// Not opened yet. `seconds` [s] after it was opened it says that it has come to an end; none: it
/// never does.
/// @throws Error: kUsage for options that are not of this device, kInput for its files, kDevice if
/// this build has no driver for it.
[[nodiscard]] std::unique_ptr<devices::Device> makeRealDevice(const std::string& name,
                                                              const RealDeviceOptions& options,
                                                              std::optional<double> seconds);

}  // namespace palpate::tools
