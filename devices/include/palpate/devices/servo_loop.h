#pragma once
/// ServoLoop: read -> tick -> write, in real time or as fast as the machine goes.

#include <atomic>
#include <cstdint>
#include <functional>

#include "palpate/devices/device.h"

namespace palpate::devices {

/// The force [N] for a reading. Must not allocate, lock, throw or block.
using ServoTick = std::function<Vec3(const DeviceState&)>;

/// What became of the force of one tick.
struct ServoTurn {
  Vec3 written{0.0, 0.0, 0.0};  ///< [N] to the device
  double share = 1.0;         ///< [-] of the force that was let through: below 1 after the watchdog
  bool is_stale = false;      ///< the tick got the previous reading again
  bool is_zeroed = false;     ///< not finite: written as zero
  bool is_shortened = false;  ///< to the device's maximum
  bool is_late = false;       ///< ended after the next tick was due (realtime only)
};

/// Called for each tick once its force was written. Must not allocate, lock, throw or block; without `realtime` it may block.
using ServoObserver = std::function<void(const ServoTurn&)>;

struct ServoSettings {
  bool realtime = false;  ///< false: as fast as possible, one reading after the other
  double rate = 1000.0;   ///< [Hz] 1 to 1e5; without `realtime` only the watchdog asks for it
  /// Try for a real-time priority of the calling thread (SCHED_FIFO) and for locked memory, for as
  /// long as the loop runs; what was refused is in the report.
  bool elevate = false;
  /// [s] without a new reading after which the force is zero; above 0. Without `realtime` a turn of
  /// the loop counts as 1 / rate. At least one turn may pass without a reading, however slow the
  /// loop is.
  double watchdog = 0.02;
  /// [s] from zero to full force once readings come again after that; 0 or more.
  double recovery = 0.1;
};

enum class ServoExit : std::uint8_t { kEnd, kStopped, kTimeout, kDisconnected, kFault };

struct ServoReport {
  ServoExit exit = ServoExit::kEnd;
  std::uint64_t ticks = 0;         ///< times the tick function was called
  std::uint64_t overruns = 0;      ///< ticks that ended after the next was due (realtime only)
  double worst_lateness = 0.0;     ///< [s] of a tick's start (realtime only)
  bool has_priority = false;       ///< ran with a real-time priority because of `elevate`
  bool has_locked_memory = false;  ///< ran with locked memory because of `elevate`
  bool elevated = false;           ///< both
  std::uint64_t zeroed = 0;        ///< forces that were not finite and were written as zero
  std::uint64_t shortened = 0;  ///< forces longer than the device's maximum, written at that length
  std::uint64_t stale = 0;  ///< turns of the loop that wrote zero because no new reading had come
};

/// Runs the loop on the calling thread until the path ends, the device fails or `stop` becomes true.
/// Opens the device first and closes it last; whatever ends the loop (a tick that throws against its
/// contract, too), the last thing written to the device is zero force.
///
/// - A force that is not finite, or that answers a position or velocity that is not finite, is written
///   as zero. One longer than DeviceInfo::max_force is shortened to it, its direction kept.
/// - kStale: the tick gets the previous reading again; before the first reading it is not called.
/// - Watchdog: once the last new reading is `watchdog` old, zero is written and the tick is not
///   called, until a new reading comes; from then on forces grow from zero to their full length
///   within `recovery`.
/// - A device whose maximum force is NaN, zero or below is written zero.
/// - kTimeout, kDisconnected, kFault and kEnd, from read() or write(), end the loop.
/// - realtime: tick k is due at start + k / rate by the monotonic clock. After an overrun the ticks
///   that were missed are skipped, never made up for.
///
/// The loop itself never allocates, locks or throws.
/// @throws Error (kDevice) from opening; Error (kUsage) for an empty `tick`, a bad rate (realtime),
/// watchdog or recovery.
[[nodiscard]] ServoReport runServo(Device& device, const ServoTick& tick,
                                   const ServoSettings& settings, const std::atomic<bool>& stop,
                                   const ServoObserver& observer = {});

}  // namespace palpate::devices
