#pragma once
/// What `palpate import` tells: regions, islands, what was changed, and what the grids will cost.

#include <string>
#include <vector>

#include "import/imported_scene.h"
#include "report.h"

namespace palpate::tools {

/// `written`: the files that were; none if it was a dry run.
[[nodiscard]] Report importReport(const ImportOptions& options, const ImportedScan& scan,
                                  const TissueTable& tissues,
                                  const std::vector<std::string>& written);

}  // namespace palpate::tools
