#pragma once
// The monotonic clock of this process, driven by an emulated device.

#include "devices/falcon_emulator.h"

namespace palpate::devices {

/// While it exists, CLOCK_MONOTONIC advances from its last value by the emulation's time, and by
/// half a microsecond for each reading of the clock, so that no wait lasts forever. Sleeps still
/// take real time. Only one may exist at a time.
class VirtualClock {
 public:
  explicit VirtualClock(const FalconEmulator& falcon);
  ~VirtualClock();
  VirtualClock(const VirtualClock&) = delete;
  VirtualClock& operator=(const VirtualClock&) = delete;
};

}  // namespace palpate::devices
