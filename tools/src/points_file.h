#pragma once
/// Points to query, out of a CSV file.

#include <string>
#include <vector>

#include "text.h"

namespace palpate::tools {

/// Header `x,y,z`, then one point a line, in `unit`; to [m]. Blank lines are skipped; CRLF too.
/// @throws Error (kInput) with file:line.
[[nodiscard]] std::vector<Vec3> readPoints(const std::string& file, const LengthUnit& unit);

}  // namespace palpate::tools
