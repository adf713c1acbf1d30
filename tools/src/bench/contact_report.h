#pragma once
/// Formats the results of `palpate bench contact` for people, for programs, and as a picture.

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
  int number = 0;  ///< number of the case, from 1
  RendererKind renderer = RendererKind::kConstraint;
  std::optional<Measurement> figures = {};
  std::string why = {};  ///< why figures are missing
};

[[nodiscard]] Json rowJson(const BenchRow& row);
/// Two tables, times and errors. A dash means that the value was not measured or judged.
[[nodiscard]] std::string tablesText(const std::vector<BenchRow>& rows);
/// An empty cell means that the value was not measured or judged.
[[nodiscard]] std::string csvText(const std::vector<BenchRow>& rows);
/// Error over time, for the rows that are judged.
[[nodiscard]] std::string svgText(const std::vector<BenchRow>& rows, const Machine& machine);

}  // namespace palpate::tools
