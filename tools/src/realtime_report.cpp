#include "realtime_report.h"

#include "text.h"

namespace palpate::tools {
namespace {

/// "50 %: 8.2 us, 99.9 %: 41 us, at most 0.2 ms"
std::string latencyText(const devices::LatencyHistogram& times) {
  const auto text = [](std::int64_t ns) { return formatNanoseconds(static_cast<double>(ns)); };
  return "50 %: " + text(times.quantile(0.5)) + ", 99.9 %: " + text(times.quantile(0.999)) +
         ", at most " + text(times.longest());
}

}  // namespace

Json latencyJson(const devices::LatencyHistogram& times) {
  return {{"p50", times.quantile(0.5)},
          {"p99", times.quantile(0.99)},
          {"p999", times.quantile(0.999)},
          {"max", times.longest()}};
}

Json realtimeJson(const devices::ServoReport& servo, bool is_paced_by_device) {
  Json json = {{"clock", is_paced_by_device ? "device" : "machine"},
               {"interval_ns", latencyJson(servo.interval)},
               {"work_ns", latencyJson(servo.work)},
               {"elevated", servo.elevated}};
  if (!is_paced_by_device) {
    json["overruns"] = servo.overruns;
    json["worst_lateness_s"] = servo.worst_lateness;
    json["late_ns"] = latencyJson(servo.lateness);
  }
  return json;
}

std::string realtimeText(const devices::ServoReport& servo, bool is_paced_by_device) {
  const std::string text =
      is_paced_by_device ? "paced by the device; time between turns " + latencyText(servo.interval)
                         : std::to_string(servo.overruns) + " overruns; turns began late by " +
                               latencyText(servo.lateness);
  return "Real time   " + text + (servo.elevated ? "\n" : "; without real-time priority\n");
}

}  // namespace palpate::tools
