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
  std::string why = {};  ///< the reason why figures are missing
};

[[nodiscard]] Json rowJson(const BenchRow& row);
/// Two tables, times and errors. A dash stands for what was not measured or judged.
[[nodiscard]] std::string tablesText(const std::vector<BenchRow>& rows);
/// An empty cell stands for what was not measured or judged.
[[nodiscard]] std::string csvText(const std::vector<BenchRow>& rows);
/// Error against time, of the rows that are judged.
[[nodiscard]] std::string svgText(const std::vector<BenchRow>& rows, const Machine& machine);

}  // namespace palpate::tools
