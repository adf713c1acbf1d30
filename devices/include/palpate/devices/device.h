#pragma once
/// Device: reads where the hand is and exerts the force that it feels; and the loop that reads,
/// ticks and writes, in real time or as fast as the machine can.

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "palpate/core/math.h"
#include "palpate/devices/latency_histogram.h"
#include "palpate/devices/safety_limits.h"
#include "palpate/devices/safety_state.h"
#include "palpate/export.h"

/// Devices and simulated hands, the servo loop, and the session that joins a device to a scene.
namespace palpate::devices {

/// One reading.
struct DeviceState {
  double time = 0.0;             ///< [s] since the device was opened
  Vec3 position{0.0, 0.0, 0.0};  ///< [m] in the frame that DeviceInfo names
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s] in the same frame
  std::uint32_t buttons = 0;     ///< one bit each, 1: pressed
  bool is_homed = true;          ///< the device knows its origin; until then it gets zero force
  Mat3 orientation{1.0};         ///< of the handle: rotates its axes into those of the frame
};

/// The outcome of read() and write().
enum class DeviceStatus : std::uint8_t {
  kOk,            ///< done; read() has returned a new reading
  kEnd,           ///< a recorded or generated path is over; the loop ends
  kStale,         ///< nothing new since the last call; the previous reading was returned
  kTimeout,       ///< no answer within the time that the device allows
  kDisconnected,  ///< will not recover without open()
  kFault,         ///< the device reported an error and has cut its motors
};

/// The frame that a device's coordinates refer to.
enum class DeviceFrame : std::uint8_t {
  kDevice,  ///< its own; a scene's DeviceMapping maps it to the world
  kWorld,   ///< the scene's world, as for most recorded paths
};

/// The constant description of a device.
struct DeviceInfo {
  std::string name;        ///< for reports and messages: "virtual", "simulated touch"
  double max_force = 0.0;  ///< [N] continuous; the servo loop never writes a longer force
  Box3 workspace;          ///< [m] in the frame
  DeviceFrame frame = DeviceFrame::kDevice;  ///< of positions, velocities, forces and the workspace
  double max_torque = 0.0;                   ///< [Nm] 0: it has no motors for a torque
  int buttons = 0;                           ///< number of buttons
  SafetyLimits limits = {};                  ///< limits that the servo loop keeps
  /// read() waits for the device's next reply, so that the device is the clock of a real-time loop,
  /// which then has no other.
  bool is_clock = false;
};

/// open() and close() are called while no loop runs; read() and write() from the servo thread only;
/// cut() from any thread. A device that is closed exerts no force: close() and the destructor zero
/// it first.
class PALPATE_EXPORT Device {
 public:
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  virtual void open() = 0;            ///< @throws Error (kDevice)
  virtual void close() noexcept = 0;  ///< safe to call twice
  /// Constant while the device is open; open() may change it.
  [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

  // Real time: no allocation, no lock, no exception, bounded wait.
  /// The newest reading. Servo thread only, while the device is open. If the result is not kOk,
  /// `out` may be unchanged.
  [[nodiscard]] virtual DeviceStatus read(DeviceState& out) noexcept = 0;
  [[nodiscard]] virtual DeviceStatus write(
      const Vec3& force) noexcept = 0;  ///< [N] in the same frame
  /// The same with a torque [Nm]. The default ignores the torque, for devices whose max_torque is
  /// 0.
  [[nodiscard]] virtual DeviceStatus writeWrench(const Vec3& force, const Vec3& torque) noexcept;

  /// Sets the force to zero at once, because the servo thread hangs: called from another thread,
  /// possibly while read() or write() runs, and only between open() and close(). Bounded wait;
  /// never throws. Later writes take effect again. The default does nothing, for devices that
  /// release the force by themselves when nobody writes.
  virtual void cut() noexcept;

 protected:
  Device() = default;
};

/// The force [N] for a reading. Must not allocate, lock, throw or block.
using ServoTick = std::function<Vec3(const DeviceState&)>;

/// The outcome of one tick's force.
struct ServoTurn {
  Vec3 written{0.0, 0.0, 0.0};  ///< [N] to the device
  double share = 1.0;           ///< [-] share of the force passed on; below 1 after the watchdog
  bool is_stale = false;        ///< the tick got the previous reading again
  bool is_zeroed = false;       ///< the force was not finite: zero was written
  bool is_shortened = false;    ///< the force was shortened to the device's maximum
  bool is_late = false;         ///< the tick ended after the next one was due (realtime only)
};

/// Called for each tick after its force was written. Must not allocate, lock, throw or block;
/// without `realtime` it may block.
using ServoObserver = std::function<void(const ServoTurn&)>;

/// Whether the loop requests real-time priority and locked memory from the operating system.
enum class Elevate : std::uint8_t {
  kOff,      ///< nothing
  kPrefer,   ///< try; the report lists what was refused
  kRequire,  ///< the loop does not run without it
};

/// For SCHED_FIFO: above the threaded interrupts (50), below the kernel's own migration and
/// watchdog threads (99).
inline constexpr int kServoPriority = 75;

/// The settings of runServo().
struct ServoSettings {
  bool realtime = false;  ///< false: as fast as possible, one reading after the other
  double rate =
      1000.0;  ///< [Hz] 1 to 1e5; without `realtime` only the watchdog and the first tick use it
  /// Whether the calling thread gets a real-time priority (SCHED_FIFO) and locked memory while the
  /// loop runs.
  Elevate elevate = Elevate::kOff;
  /// [s] without a new reading after which the force is zero; above 0. Without `realtime` a turn of
  /// the loop counts as 1 / rate. At least one turn may pass without a reading, however slow the
  /// loop is.
  double watchdog = 0.02;
  /// [s] from zero to full force when readings come again after the watchdog; 0 or more.
  double recovery = 0.1;
};

/// The event that ended the servo loop.
enum class ServoExit : std::uint8_t {
  kEnd,           ///< the device answered DeviceStatus::kEnd
  kStopped,       ///< `stop` became true
  kTimeout,       ///< the device answered DeviceStatus::kTimeout
  kDisconnected,  ///< the device answered DeviceStatus::kDisconnected
  kFault  ///< the device answered DeviceStatus::kFault, or ServoReport::fault has the reason
};

/// The result of runServo(); counts begin with its call.
struct ServoReport {
  ServoExit exit = ServoExit::kEnd;  ///< event that ended the loop
  std::uint64_t ticks = 0;           ///< times the tick function was called
  std::uint64_t overruns = 0;        ///< ticks that ended after the next was due (realtime only)
  double worst_lateness = 0.0;       ///< [s] of a tick's start (realtime only)
  bool has_priority = false;         ///< ran with a real-time priority because of `elevate`
  bool has_locked_memory = false;    ///< ran with locked memory because of `elevate`
  bool elevated = false;             ///< has_priority and has_locked_memory
  int priority_error = 0;            ///< errno of a refused priority
  int memory_error = 0;              ///< errno of refused locked memory
  std::uint64_t zeroed = 0;          ///< forces that were not finite and were written as zero
  std::uint64_t shortened = 0;  ///< forces longer than the device's maximum, written at that length
  std::uint64_t stale = 0;  ///< turns of the loop that wrote zero because no new reading had come
  SafetyState state = SafetyState::kClosed;  ///< state in which the loop ended
  SafetyFault fault = SafetyFault::kNone;    ///< kNone unless `state` is SafetyState::kFault
  SafetyCounts safety;                       ///< jumps, hangs and heat
  LatencyHistogram lateness;  ///< of each turn's start (realtime, unless the device is the clock)
  LatencyHistogram interval;  ///< from turn to turn (realtime only)
  LatencyHistogram work;      ///< from the reading to the end of the write (realtime only)
};

/// Runs the loop on the calling thread until the path ends, the device fails or `stop` becomes
/// true. Opens the device first and closes it last. Whatever ends the loop (even a tick that throws
/// against its contract), the last thing written to the device is zero force.
///
/// - A force that is not finite, or that answers a position or velocity that is not finite, is
///   written as zero. A force longer than DeviceInfo::max_force is shortened to it; its direction
///   is kept.
/// - kStale: the tick gets the previous reading again; before the first reading it is not called.
/// - Watchdog: when the last new reading is `watchdog` old, zero is written and the tick is not
///   called until a new reading comes; from then on forces grow from zero to their full length
///   within `recovery`.
/// - To a device whose maximum force is NaN, zero or negative, zero is written.
/// - DeviceInfo::limits apply. A reading that is a jump is ignored. Until the device is homed, zero
///   is written and the tick is not called. A SafetyFault ends the loop with kFault.
/// - kTimeout, kDisconnected, kFault and kEnd, from read() or write(), end the loop.
/// - realtime: tick k is due at start + k / rate by the monotonic clock. After an overrun the
///   missed ticks are skipped, never made up for. If DeviceInfo::is_clock, a tick is due when the
///   device replies instead.
/// - realtime, and SafetyLimits::hang: a second thread writes zero force when the loop hangs.
///
/// The loop itself never allocates, locks or throws.
/// @throws Error (kDevice) from opening; Error (kOperation) if what kRequire demands is refused;
/// Error (kUsage) for an empty `tick`, a bad rate (realtime), watchdog or recovery.
[[nodiscard]] PALPATE_EXPORT ServoReport runServo(Device& device, const ServoTick& tick,
                                                  const ServoSettings& settings,
                                                  const std::atomic<bool>& stop,
                                                  const ServoObserver& observer = {});

}  // namespace palpate::devices
