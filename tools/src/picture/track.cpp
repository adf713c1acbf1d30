#include "picture/track.h"

#include <fstream>

#include "palpate/core/error.h"
#include "palpate/scene/units.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr const char* kHeader =
    "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,region,contact,event,tick_"
    "ns";
constexpr std::size_t kColumns = 14;

}  // namespace

Box3 Track::bounds() const {
  Box3 box;
  for (const Point& p : points) {
    box.include(p.hip);
    box.include(p.proxy);
  }
  return box;
}

Track trackOf(std::span<const TraceRow> rows) {
  Track track;
  track.points.reserve(rows.size());
  for (const TraceRow& row : rows) {
    if (!isFinite(row.hip)) continue;  // a broken sensor's reading has no place
    track.points.push_back({row.hip, row.result.proxy, row.result.force});
  }
  return track;
}

Track readTrack(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw inputError("trace.missing", "cannot read the file", "check the path", file);
  std::string line;
  int number = 1;
  const auto bad = [&](std::string message, std::string hint) {
    return Error(ErrorKind::kInput,
                 {"trace.line", std::move(message), std::move(hint), file, number, 1, line});
  };
  const auto chop = [&] {
    if (!line.empty() && line.back() == '\r') line.pop_back();
  };
  std::getline(in, line);
  chop();
  if (line != kHeader) {
    throw bad("this is not a trace", "write one with palpate touch SCENE ... --trace FILE.csv");
  }
  Track track;
  while (std::getline(in, line)) {
    ++number;
    chop();
    if (line.empty()) continue;
    const auto parts = split(line, ',');
    // Names may hold commas of their own; the numbers come before them.
    if (parts.size() < kColumns) throw bad("a row of a trace has 14 columns", "");
    double numbers[10] = {};
    bool finite = true;
    for (std::size_t i = 0; i < 10; ++i) {
      const auto value = parseNumber(parts[i]);
      const bool broken = parts[i] == "nan" || parts[i] == "inf" || parts[i] == "-inf";
      if (!value && !broken) throw bad("'" + std::string(parts[i]) + "' is not a number", "");
      finite = finite && !broken;
      numbers[i] = value.value_or(0.0);
    }
    if (!finite) continue;  // a broken sensor's reading has no place
    track.points.push_back({Vec3(numbers[1], numbers[2], numbers[3]),
                            Vec3(numbers[4], numbers[5], numbers[6]),
                            Vec3(numbers[7], numbers[8], numbers[9])});
  }
  if (track.points.empty()) throw inputError("trace.empty", "the trace has no rows", "", file);
  return track;
}

}  // namespace palpate::tools
