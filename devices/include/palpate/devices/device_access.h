#pragma once
/// Facts for the user of a device: a notice, and the udev rule that gives access to it.

#include <cstdint>
#include <string>

#include "palpate/export.h"

namespace palpate::devices {

/// True of every driver here; to be printed wherever a device is offered or used.
constexpr const char* kUnverifiedNotice = "protocol from public sources, unverified on hardware";

/// The line of /etc/udev/rules.d/70-haptics.rules that gives access to the device to the group
/// plugdev and to the user logged in at the machine.
[[nodiscard]] PALPATE_EXPORT std::string udevRule(std::uint16_t vendor, std::uint16_t product);

}  // namespace palpate::devices
