#include "palpate/devices/servo_loop.h"

#include <cmath>
#include <string>

#include "palpate/core/error.h"
#include "servo_clock.h"
#include "servo_schedule.h"

namespace palpate::devices {
namespace {

/// Zero force, then closed, however the loop is left.
class OpenDevice {
 public:
  explicit OpenDevice(Device& device) : device_(device) { device_.open(); }
  ~OpenDevice() {
    // A device that is gone cannot be told; one that only timed out may still hold its motors.
    static_cast<void>(device_.write(Vec3(0.0)));
    device_.close();
  }
  OpenDevice(const OpenDevice&) = delete;
  OpenDevice& operator=(const OpenDevice&) = delete;

 private:
  Device& device_;
};

/// True if `status` ends the loop; says how.
bool ends(DeviceStatus status, ServoExit& exit) noexcept {
  switch (status) {
    case DeviceStatus::kOk:
    case DeviceStatus::kStale:
      return false;
    case DeviceStatus::kEnd:
      exit = ServoExit::kEnd;
      return true;
    case DeviceStatus::kTimeout:
      exit = ServoExit::kTimeout;
      return true;
    case DeviceStatus::kDisconnected:
      exit = ServoExit::kDisconnected;
      return true;
    case DeviceStatus::kFault:
      break;
  }
  exit = ServoExit::kFault;
  return true;
}

void check(const ServoTick& tick, const ServoSettings& settings) {
  if (!tick) throw Error(ErrorKind::kUsage, {"servo.tick", "the servo loop needs a tick function"});
  if (settings.realtime && !(settings.rate >= 1.0 && settings.rate <= 1e5)) {
    throw Error(ErrorKind::kUsage, {"servo.rate", "the servo rate must be 1 to 1e5 Hz, not " +
                                                      std::to_string(settings.rate)});
  }
}

}  // namespace

ServoReport runServo(Device& device, const ServoTick& tick, const ServoSettings& settings,
                     const std::atomic<bool>& stop) {
  check(tick, settings);
  ServoReport report;
  const OpenDevice open(device);
  const Elevation elevation(settings.elevate, settings.realtime);
  report.has_priority = elevation.hasPriority();
  report.has_locked_memory = elevation.hasLockedMemory();
  report.elevated = report.has_priority && report.has_locked_memory;

  // A maximum that is not a number is no permission.
  const double limit = device.info().max_force > 0.0 ? device.info().max_force : 0.0;
  DeviceState last;
  bool has_reading = false;
  const std::int64_t period = settings.realtime ? std::llround(1e9 / settings.rate) : 1;
  ServoSchedule schedule(settings.realtime ? monotonicNs() : 0, period);
  while (true) {
    if (settings.realtime) sleepUntil(schedule.due(), stop);
    if (stop.load(std::memory_order_relaxed)) {
      report.exit = ServoExit::kStopped;
      break;
    }
    if (settings.realtime) schedule.begin(monotonicNs());
    DeviceState fresh = last;
    const DeviceStatus read = device.read(fresh);
    if (ends(read, report.exit)) break;
    if (read == DeviceStatus::kOk) {
      last = fresh;
      has_reading = true;
    }
    Vec3 force(0.0);
    if (has_reading) {
      force = tick(last);
      ++report.ticks;
      if (!isFinite(force) || !isFinite(last.position) || !isFinite(last.velocity)) {
        force = Vec3(0.0);
        ++report.zeroed;
      } else if (const double length = glm::length(force); length > limit) {
        force *= limit / length;
        ++report.shortened;
      }
    }
    if (ends(device.write(force), report.exit)) break;
    if (settings.realtime) schedule.end(monotonicNs());
  }
  report.overruns = schedule.overruns();
  report.worst_lateness = 1e-9 * static_cast<double>(schedule.worstLateness());
  return report;
}

}  // namespace palpate::devices
