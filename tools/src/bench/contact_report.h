#pragma once
/// What `palpate bench contact` found: for people, for programs, and as a picture.

#include <optional>
#include <string>
#include <vector>

#include "bench/contact_case.h"
#include "bench/machine.h"
#include "bench/measure.h"
#include "report.h"

namespace palpate::tools {

struct BenchRow {
  const CaseEntry* entry = nullptr;
  int number = 0;  ///< of the case, from 1
  RendererKind renderer = RendererKind::kConstraint;
  std::optional<Measurement> figures = {};
  std::string why = {};  ///< there are no figures
};

[[nodiscard]] Json rowJson(const BenchRow& row);
/// Two tables, times and errors. What was not measured or is not judged is a dash.
[[nodiscard]] std::string tablesText(const std::vector<BenchRow>& rows);
/// What was not measured or is not judged is an empty cell.
[[nodiscard]] std::string csvText(const std::vector<BenchRow>& rows);
/// Error against time, of the rows that are judged.
[[nodiscard]] std::string svgText(const std::vector<BenchRow>& rows, const Machine& machine);

}  // namespace palpate::tools
