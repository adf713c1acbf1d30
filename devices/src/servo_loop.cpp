#include <algorithm>
#include <cmath>
#include <string>

#include "palpate/core/error.h"
#include "palpate/devices/device.h"
#include "reading_watch.h"
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
  constexpr double kLongest = 1e6;  // [s] far beyond use, well within a clock's nanoseconds
  if (!(settings.watchdog > 0.0 && settings.watchdog <= kLongest)) {
    throw Error(ErrorKind::kUsage,
                {"servo.watchdog", "the servo watchdog must be above 0 s and at most 1e6 s, not " +
                                       std::to_string(settings.watchdog)});
  }
  if (!(settings.recovery >= 0.0 && settings.recovery <= kLongest)) {
    throw Error(ErrorKind::kUsage,
                {"servo.recovery", "the servo recovery must be from 0 s to 1e6 s, not " +
                                       std::to_string(settings.recovery)});
  }
}

/// [ns]
std::int64_t nanoseconds(double seconds) noexcept { return std::llround(1e9 * seconds); }

/// [ns] of a turn of the loop; without a clock and without a sound rate, of one at 1 kHz.
std::int64_t turnOf(const ServoSettings& settings) noexcept {
  const bool is_sound = settings.rate >= 1.0 && settings.rate <= 1e5;
  return nanoseconds(1.0 / (is_sound ? settings.rate : 1000.0));
}

}  // namespace

ServoReport runServo(Device& device, const ServoTick& tick, const ServoSettings& settings,
                     const std::atomic<bool>& stop, const ServoObserver& observer) {
  check(tick, settings);
  ServoReport report;
  const OpenDevice open(device);
  const Elevation elevation(settings.elevate, settings.realtime);
  report.has_priority = elevation.hasPriority();
  report.has_locked_memory = elevation.hasLockedMemory();
  report.elevated = report.has_priority && report.has_locked_memory;

  // A maximum that is not a number is not a permission.
  const double limit = device.info().max_force > 0.0 ? device.info().max_force : 0.0;
  DeviceState last;
  bool has_reading = false;
  const std::int64_t period = settings.realtime ? std::llround(1e9 / settings.rate) : 1;
  ServoSchedule schedule(settings.realtime ? monotonicNs() : 0, period);
  const std::int64_t turn = turnOf(settings);
  ReadingWatch watch(std::max(nanoseconds(settings.watchdog), 2 * turn),
                     nanoseconds(settings.recovery));
  std::int64_t now = 0;
  while (true) {
    if (settings.realtime) sleepUntil(schedule.due(), stop);
    if (stop.load(std::memory_order_relaxed)) {
      report.exit = ServoExit::kStopped;
      break;
    }
    now = settings.realtime ? monotonicNs() : now + turn;
    if (settings.realtime) schedule.begin(now);
    DeviceState fresh = last;
    const DeviceStatus read = device.read(fresh);
    if (ends(read, report.exit)) break;
    if (read == DeviceStatus::kOk) {
      last = fresh;
      has_reading = true;
    }
    if (has_reading) watch.turn(now, read == DeviceStatus::kOk);
    Vec3 force(0.0);
    ServoTurn done{.is_stale = read == DeviceStatus::kStale};
    const bool ticks = has_reading && !watch.hasExpired();
    if (has_reading && !ticks) {
      ++report.stale;
    } else if (ticks) {
      force = tick(last);
      ++report.ticks;
      if (!isFinite(force) || !isFinite(last.position) || !isFinite(last.velocity)) {
        force = Vec3(0.0);
        ++report.zeroed;
        done.is_zeroed = true;
      } else if (const double length = glm::length(force); length > limit) {
        force *= limit / length;
        ++report.shortened;
        done.is_shortened = true;
      }
      done.share = watch.share();
      force *= done.share;
    }
    const DeviceStatus wrote = device.write(force);
    const std::uint64_t overruns = schedule.overruns();
    if (settings.realtime) schedule.end(monotonicNs());
    if (ticks && observer) {
      done.written = force;
      done.is_late = schedule.overruns() != overruns;
      observer(done);
    }
    if (ends(wrote, report.exit)) break;
  }
  report.overruns = schedule.overruns();
  report.worst_lateness = 1e-9 * static_cast<double>(schedule.worstLateness());
  return report;
}

}  // namespace palpate::devices
