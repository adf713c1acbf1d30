#pragma once
/// Formats the results of `palpate accuracy` as text, JSON, CSV and plots.

#include <string>
#include <vector>

#include "accuracy/ladder.h"
#include "bench/machine.h"
#include "report.h"
#include "text.h"

namespace palpate::tools {

[[nodiscard]] Json accuracyJson(const FieldResult& result);
/// A table for people; lengths in `unit`.
[[nodiscard]] std::string accuracyText(const FieldResult& result, const LengthUnit& unit);
/// CSV with a heading line, in SI units.
[[nodiscard]] std::string accuracyCsv(const std::vector<FieldResult>& results);
/// Plots of normal error and value error over time and memory; a line for each field and sampler.
[[nodiscard]] std::string accuracySvg(const std::vector<FieldResult>& results,
                                      const LengthUnit& unit, const Machine& machine);

}  // namespace palpate::tools
