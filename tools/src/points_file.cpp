#include "points_file.h"

#include <fstream>

#include "palpate/core/error.h"
#include "palpate/scene/units.h"

namespace palpate::tools {

std::vector<Vec3> readPoints(const std::string& file, const LengthUnit& unit) {
  std::ifstream in(file);
  if (!in) throw inputError("points.missing", "cannot read the file", "check the path", file);
  std::vector<Vec3> points;
  std::string line;
  int number = 0;
  const auto bad = [&](std::string message, std::string hint) {
    return Error(ErrorKind::kInput,
                 {"points.line", std::move(message), std::move(hint), file, number, 1, line});
  };
  bool header = false;
  while (std::getline(in, line)) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") == std::string::npos) continue;
    const auto parts = split(line, ',');
    if (!header) {
      header = parts.size() == 3 && parts[0] == "x" && parts[1] == "y" && parts[2] == "z";
      if (!header) throw bad("the header is not x,y,z", "the first line must be: x,y,z");
      continue;
    }
    Vec3 p{0.0};
    if (parts.size() != 3) throw bad("this line does not hold three numbers", "");
    for (int i = 0; i < 3; ++i) {
      const auto value = parseNumber(parts[static_cast<std::size_t>(i)]);
      if (!value) {
        throw bad("'" + std::string(parts[static_cast<std::size_t>(i)]) + "' is not a number", "");
      }
      p[i] = *value;
    }
    points.push_back(p * unit.meters);
  }
  if (points.empty()) throw inputError("points.empty", "there are no points in the file", "", file);
  return points;
}

}  // namespace palpate::tools
