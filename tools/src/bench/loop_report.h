#pragma once
/// Formats the results of `palpate bench stability` for people, for programs, and as maps.

#include <string>
#include <vector>

#include "bench/machine.h"
#include "report.h"
#include "support/loops/loop_limit.h"

namespace palpate::tools {

using loops::LoopLimit;

[[nodiscard]] Json limitJson(const LoopLimit& row);
[[nodiscard]] std::string limitsTable(const std::vector<LoopLimit>& rows);
[[nodiscard]] std::string limitsCsv(const std::vector<LoopLimit>& rows);

/// A map of the largest stiffness over the rate, by device, from `rows` of one scene and renderer:
/// as found, and the budget.
[[nodiscard]] std::string rateMap(const std::vector<LoopLimit>& rows, const Machine& machine);

/// A point of the map that curvatureMap() draws.
struct CurvedLimit {
  LoopLimit limit;
  double curvature_depth = 0.0;  ///< [-] at the stiffness that was found
  bool is_hollow = false;
};
/// A map of the largest stiffness over curvature times depth, by renderer.
[[nodiscard]] std::string curvatureMap(const std::vector<CurvedLimit>& rows,
                                       const Machine& machine);

}  // namespace palpate::tools
