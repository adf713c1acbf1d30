#include <algorithm>
#include <cmath>
#include <vector>

#include "doctor/device_findings.h"
#include "output_files.h"
#include "palpate/devices/device.h"
#include "palpate/devices/falcon.h"
#include "palpate/devices/safety_state.h"
#include "real_device.h"
#include "realtime_report.h"
#include "stop_signal.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

/// The table of states and events that the loop uses.
Report statesReport() {
  Report report;
  report.json = {{"schema", "palpate.devices/1"}, {"states", Json::array()}};
  report.text = "state         event                      then\n";
  const auto pad = [](std::string_view text, std::size_t width) {
    return std::string(text) + std::string(width - std::min(width - 1, text.size()), ' ');
  };
  for (const devices::SafetyRule& rule : devices::kSafetyRules) {
    if (rule.from == rule.to) continue;
    report.json["states"].push_back({{"from", devices::nameOf(rule.from)},
                                     {"event", devices::nameOf(rule.event)},
                                     {"to", devices::nameOf(rule.to)}});
    report.text += pad(devices::nameOf(rule.from), 14) + pad(devices::nameOf(rule.event), 27) +
                   std::string(devices::nameOf(rule.to)) + "\n";
  }
  report.text +=
      "\nA force is written while ramping or active only. Every other event leaves the state as it "
      "is.\n";
  return report;
}

/// The result of a loop with zero force: what the device reported.
struct Watched {
  devices::ServoReport servo;
  Box3 range;                 ///< [m]
  Vec3 mean{0.0, 0.0, 0.0};   ///< [m] of the last second
  std::uint32_t buttons = 0;  ///< all that were pressed
};

/// Runs `device`, whose time ends after `seconds` [s]. @throws Error: as runServo(); kCancelled
/// after a stop.
Watched watch(devices::Device& device, double seconds, Console& console) {
  Watched out;
  constexpr double kLast = 1.0;  // [s] interval of the mean
  Vec3 sum(0.0);
  std::uint64_t count = 0;
  const auto tick = [&](const devices::DeviceState& state) {
    out.range.include(state.position);
    out.buttons |= state.buttons;
    if (state.time > seconds - kLast) {
      sum += state.position;
      ++count;
    }
    return Vec3(0.0);
  };
  console.note("zero force for " + formatSeconds(seconds) +
               "; where the device asks for its origin, pull the grip out, then push it in");
  out.servo = devices::runServo(
      device, tick, {.realtime = true, .elevate = devices::Elevate::kPrefer}, stopRequested());
  checkStop();
  if (count > 0) out.mean = sum / static_cast<double>(count);
  return out;
}

/// Why the readings cannot be used; empty if they can.
std::string failureOf(const Watched& w) {
  if (w.servo.fault != devices::SafetyFault::kNone) {
    return std::string(devices::textOf(w.servo.fault));
  }
  return w.servo.ticks > 0 ? "" : "the device did not find its origin in time";
}

Json watchedJson(const Watched& w) {
  return {{"ticks", w.servo.ticks},
          {"interval_ns", latencyJson(w.servo.interval)},
          {"jumps", w.servo.safety.jumps},
          {"state", devices::nameOf(w.servo.state)},
          {"fault", devices::textOf(w.servo.fault)},
          {"buttons", w.buttons}};
}

Report testReport(const DevicesOptions& options, Console& console) {
  const auto device = makeRealDevice(options.test, options.device, options.seconds);
  const Watched w = watch(*device, options.seconds, console);
  Report report;
  report.json = {{"schema", "palpate.devices/1"}, {"test", options.test}};
  report.json["notice"] = noticeOf(options.test);
  report.json["result"] = watchedJson(w);
  const Vec3 size = w.range.isEmpty() ? Vec3(0.0) : 1e3 * w.range.size();
  const std::string failure = failureOf(w);
  report.is_yes = failure.empty();
  report.text =
      device->info().name + ": " + std::to_string(w.servo.ticks) + " readings, one every " +
      formatSeconds(1e-9 * static_cast<double>(w.servo.interval.quantile(0.5))) +
      " (99 %: within " +
      formatSeconds(1e-9 * static_cast<double>(w.servo.interval.quantile(0.99))) + ")\n" +
      "Moved within " + formatVector(size, 3) +
      " mm; buttons pressed: " + std::to_string(w.buttons) +
      "; jumps dropped: " + std::to_string(w.servo.safety.jumps) + "\nEnded " +
      std::string(devices::nameOf(w.servo.state)) + ": " +
      (failure.empty() ? "no fault" : failure) + "\nThe driver: " + noticeOf(options.test) + "\n";
  return report;
}

Report calibrationReport(const DevicesOptions& options, const GeneralOptions& general,
                         Console& console) {
  OutputFiles files(general);
  files.announce(options.calibrate, {options.device.calibration});
  devices::FalconCalibration constants;
  if (!options.device.calibration.empty()) {
    constants = devices::readFalconCalibration(options.device.calibration);
  }
  const auto device = makeRealDevice("falcon", options.device, options.seconds);
  console.note("hold the grip still where the origin shall be");
  const Watched w = watch(*device, options.seconds, console);
  if (const std::string failure = failureOf(w); !failure.empty()) {
    throw Error(ErrorKind::kDevice, {"device.calibrate", "nothing was calibrated: " + failure,
                                     "home the device, hold it still, and try again"});
  }
  constants.origin += w.mean;
  files.write(options.calibrate, devices::textOf(constants));
  files.commit();
  Report report;
  report.json = {{"schema", "palpate.devices/1"}, {"calibration", options.calibrate}};
  report.text =
      "Written  " + options.calibrate +
      "\nThe force's scale in it is assumed: hang a spring balance on the grip, compare, and "
      "correct counts_per_torque by the ratio\n";
  return report;
}

}  // namespace

Report run(const DevicesOptions& options, const GeneralOptions& general, Console& console) {
  if (options.states) return statesReport();
  if (!options.test.empty()) return testReport(options, console);
  if (!options.calibrate.empty()) return calibrationReport(options, general, console);
  const auto found = deviceFindings();
  Report report;
  report.json = {{"schema", "palpate.devices/1"}, {"devices", findingsJson(found)}};
  report.text = findingsText(found);
  return report;
}

}  // namespace palpate::tools
