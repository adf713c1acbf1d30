#pragma once
/// The motion of the hand that the options of `touch` describe.

#include <optional>

#include "options.h"
#include "palpate/devices/path.h"
#include "text.h"

namespace palpate::tools {

/// Checks that there is exactly one motion, or none where a hand moves the device, and that all
/// parameters apply to it. @throws Error (kUsage).
void checkMotion(const TouchOptions& options);

/// A hand's motion: from a file, or by a formula.
struct Motion {
  devices::RecordedPath recorded;
  devices::PathRules rules = devices::PathRules::kSound;  ///< for `recorded`
  std::optional<devices::PathFormula> formula;            ///< none: `recorded` is the motion
  double begin = 0.0;   ///< [s] of the first row whose time is a number
  double end = 0.0;     ///< [s] time of the last such row
  double period = 0.0;  ///< [s] from tick to tick
};

/// @throws Error: kUsage for wrong values, kInput for a faulty path file.
[[nodiscard]] Motion makeMotion(const TouchOptions& options, const LengthUnit& unit);

/// [s] Time from tick to tick: the median of the path's steps, so that gaps, and times that do not
/// rise, do not count. For a path without a step, 1 / `rate` [Hz].
[[nodiscard]] double nominalPeriod(const devices::Path& path, double rate);

}  // namespace palpate::tools
