#pragma once
// Settings of the servo loop that cannot be.

#include "palpate/devices/device.h"

namespace palpate::devices {

/// @throws Error (kUsage, servo.rate, servo.elevate, servo.watchdog, servo.recovery). The rate
/// counts only if it `has_rate`.
void checkServo(const ServoSettings& settings, bool has_rate);

}  // namespace palpate::devices
