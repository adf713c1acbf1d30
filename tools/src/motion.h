#pragma once
/// The hand's motion that `touch` was asked for.

#include <optional>

#include "options.h"
#include "palpate/devices/path.h"
#include "text.h"

namespace palpate::tools {

/// Exactly one motion, or none where a hand moves the device, and only parameters that apply to it.
/// @throws Error (kUsage).
void checkMotion(const TouchOptions& options);

/// A hand's motion: of a file, or by a formula.
struct Motion {
  devices::RecordedPath recorded;
  devices::PathRules rules = devices::PathRules::kSound;  ///< of `recorded`
  std::optional<devices::PathFormula> formula;            ///< none: `recorded` is the motion
  double begin = 0.0;   ///< [s] of the first row whose time is a number
  double end = 0.0;     ///< [s] of the last one
  double period = 0.0;  ///< [s] from tick to tick
};

/// @throws Error: kUsage for values, kInput for the path file.
[[nodiscard]] Motion makeMotion(const TouchOptions& options, const LengthUnit& unit);

/// [s] from tick to tick: what half of the path's steps do not exceed, so that gaps in it do not
/// count, nor times that do not rise. Of a path without a step, 1 / `rate` [Hz].
[[nodiscard]] double nominalPeriod(const devices::Path& path, double rate);

}  // namespace palpate::tools
