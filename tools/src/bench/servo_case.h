#pragma once
/// Measures how late this machine wakes a servo loop.

#include <string>
#include <vector>

#include "console.h"
#include "palpate/devices/device.h"
#include "report.h"

namespace palpate::tools {

struct ServoFigures {
  double rate = 0.0;  ///< [Hz]
  int load = 0;       ///< number of threads that only computed meanwhile
  devices::ServoReport report;
  double seconds = 0.0;

  /// True if at most one turn in ten thousand was missed, and at most one in a thousand came later
  /// than half a period.
  [[nodiscard]] bool isGood() const;
};

/// Runs an empty loop in real time for `seconds` [s]. @throws Error (kCancelled) after a stop.
[[nodiscard]] ServoFigures measureServo(double rate, int load, double seconds);

[[nodiscard]] Json servoJson(const std::vector<ServoFigures>& figures);
[[nodiscard]] std::string servoText(const std::vector<ServoFigures>& figures);

}  // namespace palpate::tools
