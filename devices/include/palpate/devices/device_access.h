#pragma once
/// What a user needs to be let at a USB device.

#include <cstdint>
#include <string>

#include "palpate/export.h"

namespace palpate::devices {

/// The line of /etc/udev/rules.d/70-haptics.rules that permits the device to the group plugdev and to who sits at the machine.
[[nodiscard]] PALPATE_EXPORT std::string udevRule(std::uint16_t vendor, std::uint16_t product);

}  // namespace palpate::devices
