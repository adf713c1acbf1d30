#pragma once
/// Query points from a CSV file.

#include <string>
#include <vector>

#include "text.h"

namespace palpate::tools {

/// Header `x,y,z`, then one point a line, in `unit`; converted to [m]. Blank lines are skipped;
/// CRLF is accepted.
/// @throws Error (kInput) with file:line.
[[nodiscard]] std::vector<Vec3> readPoints(const std::string& file, const LengthUnit& unit);

}  // namespace palpate::tools
