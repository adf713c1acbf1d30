#pragma once
/// What `palpate import` tells: regions, islands, what was changed, and what the grids will cost.

#include <string>
#include <vector>

#include "import/imported_scene.h"
#include "import/needle_way.h"
#include "report.h"

namespace palpate::tools {

/// `way`: the one that was asked for, or null. `written`: the files that were; none if it was a dry
/// run.
[[nodiscard]] Report importReport(const ImportOptions& options, const ImportedScan& scan,
                                  const TissueTable& tissues, const NeedleWay* way,
                                  const std::vector<std::string>& written);

}  // namespace palpate::tools
