#pragma once
/// The report of `palpate import`: regions, islands, changes, and the estimated cost of the grids.

#include <string>
#include <vector>

#include "import/imported_scene.h"
#include "import/needle_way.h"
#include "report.h"

namespace palpate::tools {

/// `way`: the requested one, or null. `written`: the files that were written; empty for a dry run.
[[nodiscard]] Report importReport(const ImportOptions& options, const ImportedScan& scan,
                                  const TissueTable& tissues, const NeedleWay* way,
                                  const std::vector<std::string>& written);

}  // namespace palpate::tools
