#pragma once
/// The report of `palpate info` on a file.

#include <string>

#include "console.h"
#include "options.h"
#include "palpate/core/math.h"
#include "report.h"

namespace palpate::tools {

/// One file's part of the report.
struct FileReport {
  Json json;
  std::string text;
};

/// "x y z to x y z mm"; `unit` [m].
[[nodiscard]] std::string boxText(const Box3& box, double unit, const std::string& name);

/// Reports on a scan: its place in space, its values, and its labels with their names and numbers
/// of voxels.
[[nodiscard]] FileReport imageReport(const std::string& file, const InfoOptions& options,
                                     Console& console);

}  // namespace palpate::tools
