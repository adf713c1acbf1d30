#pragma once
/// Charts of region, force, distance and energy over time, one above another, as SVG.

#include <string>
#include <vector>

#include "report_page/tick_columns.h"
#include "touch_summary.h"

namespace palpate::tools {

/// `regions` and `ports`: names by id. Lengths in mm.
[[nodiscard]] std::string stripChart(const TouchSummary& summary,
                                     const std::vector<TickColumn>& columns,
                                     const std::vector<std::string>& regions,
                                     const std::vector<std::string>& ports);

}  // namespace palpate::tools
