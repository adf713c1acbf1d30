#pragma once
/// `palpate bench stability`.

#include "console.h"
#include "options.h"
#include "report.h"

namespace palpate::tools {

/// @throws Error (kUsage) for a name that there is not.
[[nodiscard]] Report runStabilityBench(const BenchOptions& options, const GeneralOptions& general,
                                       Console& console);

}  // namespace palpate::tools
