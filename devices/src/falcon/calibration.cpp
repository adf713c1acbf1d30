#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "palpate/devices/falcon.h"

namespace palpate::devices {
namespace {

struct Entry {
  const char* name;
  double FalconCalibration::*number;  ///< null for a component of a vector
  Vec3 FalconCalibration::*vector;    ///< the vector; null for a plain number
  int axis;
  double least, most;
  const char* unit;
};

constexpr double kTurn = 7.0;  // [rad] more than a turn

constexpr std::array<Entry, 10> kEntries = {{
    {"counts_per_torque", &FalconCalibration::counts_per_torque, nullptr, 0, -1e6, 1e6,
     "counts/Nm"},
    {"radians_per_count", &FalconCalibration::radians_per_count, nullptr, 0, 1e-6, 0.1, "rad"},
    {"zero_angle_1", nullptr, &FalconCalibration::zero_angles, 0, -kTurn, kTurn, "rad"},
    {"zero_angle_2", nullptr, &FalconCalibration::zero_angles, 1, -kTurn, kTurn, "rad"},
    {"zero_angle_3", nullptr, &FalconCalibration::zero_angles, 2, -kTurn, kTurn, "rad"},
    {"origin_x", nullptr, &FalconCalibration::origin, 0, -1.0, 1.0, "m"},
    {"origin_y", nullptr, &FalconCalibration::origin, 1, -1.0, 1.0, "m"},
    {"origin_z", nullptr, &FalconCalibration::origin, 2, -1.0, 1.0, "m"},
    {"max_force", &FalconCalibration::max_force, nullptr, 0, 0.0, 100.0, "N"},
    {"continuous_force", &FalconCalibration::continuous_force, nullptr, 0, 0.0, 100.0, "N"},
}};

double& valueOf(FalconCalibration& calibration, const Entry& entry) {
  if (entry.number != nullptr) return calibration.*entry.number;
  return (calibration.*entry.vector)[entry.axis];
}

Error lineError(const std::string& file, int line, const std::string& what) {
  Problem problem{"falcon.calibration", what, "a line is `name value`", file};
  problem.line = line;
  return {ErrorKind::kInput, std::move(problem)};
}

void readLine(const std::string& text, const std::string& file, int number,
              FalconCalibration& into) {
  std::istringstream words(text.substr(0, text.find('#')));
  std::string name;
  if (!(words >> name)) return;
  std::string value;
  std::string more;
  if (!(words >> value) || (words >> more)) {
    throw lineError(file, number, "'" + name + "' needs one value");
  }
  for (const Entry& entry : kEntries) {
    if (name != entry.name) continue;
    double read = 0.0;
    const auto end = std::from_chars(value.data(), value.data() + value.size(), read);
    const bool is_whole = end.ec == std::errc() && end.ptr == value.data() + value.size();
    if (!is_whole || !(read >= entry.least && read <= entry.most)) {
      throw lineError(file, number,
                      name + " must be from " + exactNumber(entry.least) + " to " +
                          exactNumber(entry.most) + " " + entry.unit + ", not " + value);
    }
    valueOf(into, entry) = read;
    return;
  }
  throw lineError(file, number, "'" + name + "' is not a constant of a Falcon");
}

}  // namespace

FalconCalibration readFalconCalibration(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw inputError("falcon.calibration", "cannot open the calibration", "", file);
  FalconCalibration out;
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) readLine(text, file, number, out);
  return out;
}

std::string textOf(const FalconCalibration& calibration) {
  FalconCalibration copy = calibration;
  std::string out =
      "# Constants of a Novint Falcon. Constants that are not listed keep their default.\n";
  for (const Entry& entry : kEntries) {
    out += std::string(entry.name) + " " + exactNumber(valueOf(copy, entry)) + "  # " + entry.unit +
           "\n";
  }
  return out;
}

}  // namespace palpate::devices
