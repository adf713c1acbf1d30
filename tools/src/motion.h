#pragma once
/// The hand's motion that `touch` was asked for.

#include "options.h"
#include "palpate/devices/path.h"
#include "text.h"

namespace palpate::tools {

/// Exactly one motion, and only parameters that apply to it. @throws Error (kUsage).
void checkMotion(const TouchOptions& options);

/// @throws Error: kUsage for values, kInput for the path file.
[[nodiscard]] devices::Path makeMotion(const TouchOptions& options, const LengthUnit& unit);

/// [s] from tick to tick: what half of the path's steps do not exceed, so that gaps in it do not
/// count. Of a path of one row, 1 / `rate` [Hz].
[[nodiscard]] double nominalPeriod(const devices::Path& path, double rate);

}  // namespace palpate::tools
