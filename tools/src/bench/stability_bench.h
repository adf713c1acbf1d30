#pragma once
/// The verb `palpate bench stability`.

#include "console.h"
#include "options.h"
#include "report.h"

namespace palpate::tools {

/// @throws Error (kUsage) for an unknown name.
[[nodiscard]] Report runStabilityBench(const BenchOptions& options, const GeneralOptions& general,
                                       Console& console);

}  // namespace palpate::tools
