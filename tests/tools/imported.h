#pragma once
// Shared by tests of imported scans: runs the command, and touches a scene along a straight path.

#include <cstdio>

#include "palpate/core/math.h"
#include "tools/helpers.h"

namespace palpate::testing {

/// The JSON output of `palpate ARGUMENTS...`, which must succeed.
inline Json run(const TempFolder& folder, const std::vector<std::string>& arguments) {
  const CommandResult result = runPalpate(arguments, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  return parseOnly(result);
}

/// A point [mm] as an argument.
inline std::string pointText(const Vec3& mm) {
  char text[96];
  std::snprintf(text, sizeof text, "%.6f,%.6f,%.6f", mm.x, mm.y, mm.z);
  return text;
}

struct TracedTick {
  Vec3 hand{0.0};   ///< [mm]
  Vec3 proxy{0.0};  ///< [mm]
  Vec3 force{0.0};  ///< [N]
  std::string region;
};

/// Touches the scene on straight lines from point to point [mm] at `speed`, such as "20mm/s".
inline std::vector<TracedTick> touched(const TempFolder& folder, const std::string& scene,
                                       const std::vector<Vec3>& points, const std::string& speed) {
  std::vector<std::string> arguments = {"touch", scene,     "--speed", speed,     "--trace",
                                        "t.csv", "--force", "--json",  "--insert"};
  for (const Vec3& p : points) arguments.push_back(pointText(p));
  (void)run(folder, arguments);
  std::vector<TracedTick> ticks;
  for (const std::string& line : linesOf(textOf(folder.path("t.csv")))) {
    const std::vector<std::string> cells = cellsOf(line);
    if (cells[0] == "t") continue;
    const auto three = [&](std::size_t first) {
      return Vec3(std::stod(cells[first]), std::stod(cells[first + 1]),
                  std::stod(cells[first + 2]));
    };
    ticks.push_back({three(1) * 1e3, three(4) * 1e3, three(7), cells[10]});
  }
  return ticks;
}

/// Tissues for a shell around a core, whatever their names: bone that opens at 3 N, and at 2 N on
/// the way back.
inline constexpr const char* kBoneThatOpens = R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: a needle}
stiffest: {value: 2000 N/m, basis: assumed, source: a device}
tissues:
  bone:
    labels: ["*"]
    stiffness: {value: 1000 N/m, basis: assumed, source: round}
    opens_at: {value: 3 N, basis: assumed, source: round}
    back: {value: 2 N, basis: assumed, source: round}
)";

}  // namespace palpate::testing
