#pragma once
/// What `palpate bench stability` found: for people, for programs, and as maps.

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

/// Largest stiffness over rate, by device, of `rows` of one scene and renderer: found, and the
/// budget.
[[nodiscard]] std::string rateMap(const std::vector<LoopLimit>& rows, const Machine& machine);

/// A point of the map below.
struct CurvedLimit {
  LoopLimit limit;
  double curvature_depth = 0.0;  ///< [-] at the stiffness that was found
  bool is_hollow = false;
};
/// Largest stiffness over curvature times depth, by renderer.
[[nodiscard]] std::string curvatureMap(const std::vector<CurvedLimit>& rows,
                                       const Machine& machine);

}  // namespace palpate::tools
