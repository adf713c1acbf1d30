#pragma once
// The monotonic clock of this process, told by an emulated device.

#include "devices/falcon_emulator.h"

namespace palpate::devices {

/// While it lives, CLOCK_MONOTONIC goes on from where it was by the emulation's time, and by half a
/// microsecond for each look, so that nobody waits forever. Sleeps take real time all the same. One
/// at a time.
class VirtualClock {
 public:
  explicit VirtualClock(const FalconEmulator& falcon);
  ~VirtualClock();
  VirtualClock(const VirtualClock&) = delete;
  VirtualClock& operator=(const VirtualClock&) = delete;
};

}  // namespace palpate::devices
