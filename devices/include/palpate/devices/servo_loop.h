#pragma once
/// ServoLoop: read -> tick -> write, in real time or as fast as the machine goes.

#include <atomic>
#include <cstdint>
#include <functional>

#include "palpate/devices/device.h"

namespace palpate::devices {

/// The force [N] for a reading. Must not allocate, lock, throw or block.
using ServoTick = std::function<Vec3(const DeviceState&)>;

struct ServoSettings {
  bool realtime = false;  ///< false: as fast as possible, one reading after the other
  double rate = 1000.0;   ///< [Hz] if realtime; 1 to 1e5
  /// Try for a real-time priority of the calling thread (SCHED_FIFO) and for locked memory, for as
  /// long as the loop runs; what was refused is in the report.
  bool elevate = false;
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
};

/// Runs the loop on the calling thread until the path ends, the device fails or `stop` becomes true.
/// Opens the device first and closes it last; whatever ends the loop (a tick that throws against its
/// contract, too), the last thing written to the device is zero force.
///
/// - A force that is not finite, or that answers a position or velocity that is not finite, is written
///   as zero. One longer than DeviceInfo::max_force is shortened to it, its direction kept.
/// - kStale: the tick gets the previous reading again; before the first reading it is not called.
/// - kTimeout, kDisconnected, kFault and kEnd, from read() or write(), end the loop.
/// - realtime: tick k is due at start + k / rate by the monotonic clock. After an overrun the ticks
///   that were missed are skipped, never made up for.
///
/// The loop itself never allocates, locks or throws.
/// @throws Error (kDevice) from opening; Error (kUsage) for an empty `tick` or a bad rate.
[[nodiscard]] ServoReport runServo(Device& device, const ServoTick& tick,
                                   const ServoSettings& settings, const std::atomic<bool>& stop);

}  // namespace palpate::devices
