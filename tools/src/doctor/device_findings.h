#pragma once
/// Finds out which haptic devices can be reached from here, and what prevents that.

#include <string>
#include <vector>

#include "palpate/devices/device_access.h"
#include "report.h"

namespace palpate::tools {

/// One way to a device.
struct DeviceFinding {
  std::string name;   ///< name for --device
  std::string title;  ///< "Novint Falcon, USB 0403:cb48"
  std::string found;  ///< "none plugged in", "bus 1 address 4, serial X", ...
  bool is_ready = false;
  std::string remedy;  ///< empty if there is nothing to do
  std::string notice = devices::kUnverifiedNotice;
};

[[nodiscard]] std::vector<DeviceFinding> deviceFindings();
[[nodiscard]] Json findingsJson(const std::vector<DeviceFinding>& findings);
[[nodiscard]] std::string findingsText(const std::vector<DeviceFinding>& findings);

}  // namespace palpate::tools
