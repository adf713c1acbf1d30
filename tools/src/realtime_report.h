#pragma once
/// What a real-time run says of its clock.

#include <string>

#include "palpate/devices/device.h"
#include "report.h"

namespace palpate::tools {

/// Of a loop that the clock wakes: how late its turns began. Of one that its device paces
/// (DeviceInfo::is_clock): how far apart they were, as nothing says when one was due.
[[nodiscard]] Json realtimeJson(const devices::ServoReport& servo, bool is_paced_by_device);
[[nodiscard]] std::string realtimeText(const devices::ServoReport& servo, bool is_paced_by_device);

[[nodiscard]] Json latencyJson(const devices::LatencyHistogram& times);

}  // namespace palpate::tools
