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
  double rate = 1000.0;   ///< [Hz] if realtime
  /// Try for a real-time priority and locked memory; what was refused is in the report.
  bool elevate = false;
};

enum class ServoExit : std::uint8_t { kEnd, kStopped, kTimeout, kDisconnected, kFault };

struct ServoReport {
  ServoExit exit = ServoExit::kEnd;
  std::uint64_t ticks = 0;
  std::uint64_t overruns = 0;      ///< ticks that ended after the next was due (realtime only)
  double worst_lateness = 0.0;     ///< [s] of a tick's start (realtime only)
  bool elevated = false;
};

/// Runs the loop on the calling thread until the path ends, the device fails or `stop` becomes true.
/// Opens the device first and closes it last; whatever ends the loop, the last thing written to the device
/// is zero force. A force that is not finite is written as zero.
/// @throws Error (kDevice) from opening only.
[[nodiscard]] ServoReport runServo(Device& device, const ServoTick& tick,
                                   const ServoSettings& settings, const std::atomic<bool>& stop);

}  // namespace palpate::devices
