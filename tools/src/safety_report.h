#pragma once
/// Reports what the loop's safety rules did while a hand held the device.

#include <string>

#include "palpate/devices/device.h"
#include "report.h"

namespace palpate::tools {

[[nodiscard]] Json safetyJson(const devices::ServoReport& servo);
[[nodiscard]] std::string safetyText(const devices::ServoReport& servo);

}  // namespace palpate::tools
