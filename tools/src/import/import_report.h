#pragma once
/// The report of `palpate import`: regions, islands, changes, and the estimated cost of the grids.

#include <set>
#include <string>
#include <vector>

#include "import/imported_scene.h"
#include "import/needle_way.h"
#include "report.h"

namespace palpate::tools {

/// `way`: the requested one, or null. `written`: the files that were written; empty for a dry run.
/// `kept`: the names of the layers whose grids need not be made again.
[[nodiscard]] Report importReport(const ImportOptions& options, const ImportedScan& scan,
                                  const TissueTable& tissues, const NeedleWay* way,
                                  const std::vector<std::string>& written,
                                  const std::set<std::string>& kept);

}  // namespace palpate::tools
