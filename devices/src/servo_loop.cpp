#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <system_error>

#include "hang_watch.h"
#include "palpate/core/error.h"
#include "palpate/devices/device.h"
#include "palpate/devices/safety.h"
#include "servo_check.h"
#include "servo_clock.h"
#include "servo_schedule.h"

namespace palpate::devices {

void checkServo(const ServoSettings& settings, bool has_rate) {
  if (has_rate && !(settings.rate >= 1.0 && settings.rate <= 1e5)) {
    throw Error(ErrorKind::kUsage, {"servo.rate", "the servo rate must be 1 to 1e5 Hz, not " +
                                                      std::to_string(settings.rate)});
  }
  if (settings.elevate > Elevate::kRequire) {
    throw Error(ErrorKind::kUsage,
                {"servo.elevate", "unknown way of elevating the servo loop: number " +
                                      std::to_string(static_cast<int>(settings.elevate))});
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

namespace {

/// Writes zero force and closes the device, however the loop ends.
class OpenDevice {
 public:
  explicit OpenDevice(Device& device) : device_(device) { device_.open(); }
  ~OpenDevice() {
    // A device that is gone accepts no command; one that only timed out may still exert a force.
    static_cast<void>(device_.write(Vec3(0.0)));
    device_.close();
  }
  OpenDevice(const OpenDevice&) = delete;
  OpenDevice& operator=(const OpenDevice&) = delete;

 private:
  Device& device_;
};

/// True if `status` ends the loop; sets `exit` to the reason.
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

/// [ns]
std::int64_t nanoseconds(double seconds) noexcept { return std::llround(1e9 * seconds); }

/// [ns] The length of a turn of the loop; if there is no clock and the rate is invalid, that of a
/// loop at 1 kHz.
std::int64_t turnOf(const ServoSettings& settings) noexcept {
  const bool is_sound = settings.rate >= 1.0 && settings.rate <= 1e5;
  return nanoseconds(1.0 / (is_sound ? settings.rate : 1000.0));
}

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// [ns] The time after which the loop counts as hung: at least two turns, however slow it is.
std::int64_t longestTurn(const SafetyLimits& limits, std::int64_t turn) noexcept {
  if (!(limits.hang < 1e6)) return kNever;
  return std::max(nanoseconds(limits.hang), 2 * turn);
}

/// Reports what the operating system granted. @throws Error (kOperation) if `wanted` requires more.
void noteElevation(const Elevation& elevation, Elevate wanted, ServoReport& report) {
  report.has_priority = elevation.hasPriority();
  report.has_locked_memory = elevation.hasLockedMemory();
  report.elevated = report.has_priority && report.has_locked_memory;
  report.priority_error = elevation.priorityError();
  report.memory_error = elevation.memoryError();
  if (wanted != Elevate::kRequire || report.elevated) return;
  const bool lacks_priority = !report.has_priority;
  const int error = lacks_priority ? report.priority_error : report.memory_error;
  throw Error(ErrorKind::kOperation,
              {"servo.elevate",
               std::string("the system refuses ") +
                   (lacks_priority ? "a real-time priority: " : "locked memory: ") +
                   std::generic_category().message(error),
               "devices/README.md says how to allow it; or run with Elevate::kPrefer"});
}

}  // namespace

ServoReport runServo(Device& device, const ServoTick& tick, const ServoSettings& settings,
                     const std::atomic<bool>& stop, const ServoObserver& observer) {
  if (!tick) throw Error(ErrorKind::kUsage, {"servo.tick", "the servo loop needs a tick function"});
  checkServo(settings, settings.realtime);
  ServoReport report;
  const OpenDevice open(device);
  const Elevation elevation(settings.elevate != Elevate::kOff, settings.realtime);
  noteElevation(elevation, settings.elevate, report);

  const DeviceInfo& info = device.info();
  const bool has_timer = settings.realtime && !info.is_clock;
  const std::int64_t period = settings.realtime ? std::llround(1e9 / settings.rate) : 1;
  const std::int64_t turn = turnOf(settings);
  Safety safety(info.limits, info.max_force, nanoseconds(settings.watchdog),
                nanoseconds(settings.recovery), turn);
  HangWatch hangs(device, settings.realtime ? longestTurn(info.limits, turn) : kNever,
                  elevation.hasPriority() ? kServoPriority + 1 : 0);
  std::uint64_t cuts = 0;
  DeviceState last;
  bool has_reading = false;
  ServoSchedule schedule(settings.realtime ? monotonicNs() : 0, period);
  std::int64_t now = settings.realtime ? monotonicNs() : 0;
  hangs.beat(now);
  safety.open(now);
  while (true) {
    if (has_timer) sleepUntil(schedule.due(), stop);
    if (stop.load(std::memory_order_relaxed)) {
      report.exit = ServoExit::kStopped;
      break;
    }
    const std::int64_t before = now;
    now = settings.realtime ? monotonicNs() : now + turn;
    if (has_timer) {
      report.lateness.add(now - schedule.due());
      schedule.begin(now);
    }
    DeviceState fresh = last;
    const DeviceStatus read = device.read(fresh);
    // The age of a reading counts from the device's reply.
    if (settings.realtime && info.is_clock) now = monotonicNs();
    if (settings.realtime) report.interval.add(now - before);
    const ReadingVerdict verdict = safety.read(now, read, fresh);
    if (ends(read, report.exit)) break;
    if (verdict == ReadingVerdict::kSound) {
      last = fresh;
      has_reading = true;
    }
    Vec3 force(0.0);
    ServoTurn done{.is_stale = verdict != ReadingVerdict::kSound};
    const bool ticks = safety.ticks();
    if (has_reading && safety.isSilent()) ++report.stale;
    if (ticks) {
      const SafeForce safe = safety.ask(tick(last), last);
      ++report.ticks;
      force = safe.force;
      done.is_zeroed = safe.is_zeroed;
      done.is_shortened = safe.is_shortened;
      done.share = safe.share;
    } else {
      (void)safety.ask(Vec3(0.0), last);  // lets the motors cool
    }
    if (const std::uint64_t count = hangs.cuts(); count != cuts) {
      cuts = count;
      safety.hang(monotonicNs() - hangs.lastBeat());
      force = Vec3(0.0);
    }
    if (!permitsForce(safety.state())) force = Vec3(0.0);
    const DeviceStatus wrote = device.write(force);
    safety.wrote(wrote);
    const std::uint64_t overruns = schedule.overruns();
    if (settings.realtime) {
      const std::int64_t end = monotonicNs();
      hangs.beat(end);
      report.work.add(end - now);
      if (has_timer) schedule.end(end);
    }
    if (ticks && observer) {
      done.written = force;
      done.is_late = schedule.overruns() != overruns;
      observer(done);
    }
    if (ends(wrote, report.exit)) break;
    if (safety.state() == SafetyState::kFault) {
      report.exit = ServoExit::kFault;
      break;
    }
  }
  report.overruns = schedule.overruns();
  report.worst_lateness = 1e-9 * static_cast<double>(schedule.worstLateness());
  report.state = safety.state();
  report.fault = safety.fault();
  report.safety = safety.counts();
  report.zeroed = report.safety.zeroed;
  report.shortened = report.safety.shortened;
  return report;
}

}  // namespace palpate::devices
