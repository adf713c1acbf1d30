#pragma once
// Refuses impossible settings of the servo loop.

#include "palpate/devices/device.h"

namespace palpate::devices {

/// @throws Error (kUsage, servo.rate, servo.elevate, servo.watchdog, servo.recovery). The rate is
/// checked only if `has_rate`.
void checkServo(const ServoSettings& settings, bool has_rate);

}  // namespace palpate::devices
