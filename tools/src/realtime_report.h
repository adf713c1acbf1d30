#pragma once
/// The report of a real-time run on its timing.

#include <string>

#include "palpate/devices/device.h"
#include "report.h"

namespace palpate::tools {

/// For a loop that the clock wakes: how late its turns began. For one that its device paces
/// (DeviceInfo::is_clock): the intervals between turns, because nothing says when one was due.
[[nodiscard]] Json realtimeJson(const devices::ServoReport& servo, bool is_paced_by_device);
[[nodiscard]] std::string realtimeText(const devices::ServoReport& servo, bool is_paced_by_device);

[[nodiscard]] Json latencyJson(const devices::LatencyHistogram& times);

}  // namespace palpate::tools
