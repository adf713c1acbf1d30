#include "motion.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "output_files.h"
#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "real_device.h"

namespace palpate::tools {
namespace {

// No sensible path is longer; a mistake in --hold or --speed must not run for hours, or fill the
// disk.
constexpr double kLongestPath = 20e6;  // [ticks], 5.5 hours at 1 kHz

Error usageError(std::string message, std::string hint = {}) {
  return Error(ErrorKind::kUsage, {"usage.motion", std::move(message), std::move(hint)});
}

/// The option that says how the hand moves.
std::string chosenMotion(const TouchOptions& o) {
  std::string_view chosen;
  int count = 0;
  const auto look = [&](bool given, std::string_view name) {
    if (!given) return;
    chosen = name;
    ++count;
  };
  look(!o.path.empty(), "--path");
  look(!o.press.empty(), "--press");
  look(!o.stroke.empty(), "--stroke");
  look(!o.tap.empty(), "--tap");
  look(!o.insert.empty(), "--insert");
  if (isRealDevice(o.device.name)) {
    if (count == 0) return "--device " + o.device.name;
    throw usageError(
        std::string(chosen) + ": a hand moves the device " + o.device.name +
            ", so it takes no motion",
        "leave the motion out, or let a simulated device follow it: --device virtual:NAME");
  }
  if (count != 1) {
    throw usageError(count == 0 ? "the hand's motion is missing" : "more than one motion was given",
                     "exactly one of --path FILE.csv, --press X,Y,Z, --stroke A B, --tap X,Y,Z, "
                     "--insert A B ...");
  }
  return std::string(chosen);
}

double positive(double value, const char* what) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw usageError(std::string(what) + " must be greater than 0");
  }
  return value;
}

double notNegative(double value, const char* what) {
  if (!(value >= 0.0) || !std::isfinite(value)) {
    throw usageError(std::string(what) + " must not be negative");
  }
  return value;
}

int atLeastOne(int value, const char* what) {
  if (value < 1) throw usageError(std::string(what) + " must be 1 or more");
  return value;
}

void checkDuration(double seconds, double rate) {
  if (seconds * rate > kLongestPath) {
    throw usageError(
        "the motion would last " + formatSeconds(seconds) + ", more than 20 million ticks",
        "raise --speed, or shorten the way or --hold");
  }
}

}  // namespace

void checkMotion(const TouchOptions& o) {
  const std::string motion = chosenMotion(o);
  const auto only = [&](bool given, const char* name,
                        std::initializer_list<std::string_view> motions) {
    if (!given || std::find(motions.begin(), motions.end(), motion) != motions.end()) return;
    throw usageError(std::string(name) + " does not apply to " + motion,
                     "it is a parameter of " + joined(motions));
  };
  only(!o.normal.empty(), "--normal", {"--press", "--tap"});
  only(!o.depth.empty(), "--depth", {"--press", "--tap"});
  only(!o.clearance.empty(), "--clearance", {"--press", "--tap"});
  only(!o.speed.empty(), "--speed", {"--press", "--stroke", "--insert"});
  only(o.hold.has_value(), "--hold", {"--press", "--insert"});
  only(o.repeats.has_value(), "--repeats", {"--stroke"});
  only(o.frequency.has_value(), "--frequency", {"--tap"});
  only(o.taps.has_value(), "--taps", {"--tap"});
  only(o.back, "--back", {"--insert"});
  only(o.as_recorded, "--as-recorded", {"--path"});
  if (motion == "--stroke" && o.stroke.size() != 2) throw usageError("--stroke takes two points");
  if (motion == "--insert" && o.insert.size() < 2)
    throw usageError("--insert takes two points or more");
}

namespace {

Motion recordedMotion(const TouchOptions& o) {
  Motion motion;
  motion.rules = o.as_recorded ? devices::PathRules::kAsRecorded : devices::PathRules::kSound;
  motion.recorded = devices::readPath(inputName(o.path), motion.rules);
  const devices::Path& path = motion.recorded.points;
  const auto is_time = [](const devices::PathPoint& point) { return std::isfinite(point.t); };
  const auto first = std::find_if(path.begin(), path.end(), is_time);
  if (first != path.end()) {
    motion.begin = first->t;
    motion.end = std::find_if(path.rbegin(), path.rend(), is_time)->t;
  }
  motion.period = nominalPeriod(path, o.rate);
  return motion;
}

template <typename Shape>
Motion formulaMotion(const Shape& shape, double rate) {
  Motion motion;
  motion.formula = devices::formula(shape, rate);
  motion.end = motion.formula->at(motion.formula->size() - 1).t;
  motion.period = 1.0 / rate;
  return motion;
}

}  // namespace

Motion makeMotion(const TouchOptions& o, const LengthUnit& unit) {
  if (!o.path.empty()) return recordedMotion(o);
  const auto point = [&](const std::string& text, const char* what) {
    return parsePoint(text, unit, what);
  };
  const auto length = [&](const std::string& text, const char* what, double fallback) {
    return text.empty() ? fallback : notNegative(parseLength(text, unit, what), what);
  };
  const auto speed = [&](double fallback) {
    return o.speed.empty() ? fallback : positive(parseSpeed(o.speed, unit, "--speed"), "--speed");
  };
  const auto normal = [&](const Vec3& fallback) {
    if (o.normal.empty()) return fallback;
    const Vec3 n = parseVector(o.normal, "--normal");
    if (!(glm::length(n) > 0.0)) throw usageError("--normal has no direction");
    return glm::normalize(n);
  };
  const auto aim = [&](auto& shape, const std::string& at, const char* option) {
    shape.surface = point(at, option);
    shape.normal = normal(shape.normal);
    shape.depth = length(o.depth, "--depth", shape.depth);
    shape.clearance = length(o.clearance, "--clearance", shape.clearance);
  };

  if (!o.press.empty()) {
    devices::PressPath shape;
    aim(shape, o.press, "--press");
    shape.speed = speed(shape.speed);
    shape.hold = notNegative(o.hold.value_or(shape.hold), "--hold");
    checkDuration(2.0 * (shape.depth + shape.clearance) / shape.speed + shape.hold, o.rate);
    return formulaMotion(shape, o.rate);
  }
  if (!o.tap.empty()) {
    devices::TapPath shape;
    aim(shape, o.tap, "--tap");
    shape.frequency = positive(o.frequency.value_or(shape.frequency), "--frequency");
    shape.taps = atLeastOne(o.taps.value_or(shape.taps), "--taps");
    checkDuration(shape.taps / shape.frequency, o.rate);
    return formulaMotion(shape, o.rate);
  }
  if (!o.stroke.empty()) {
    devices::StrokePath shape;
    shape.from = point(o.stroke[0], "--stroke");
    shape.to = point(o.stroke[1], "--stroke");
    shape.speed = speed(shape.speed);
    shape.repeats = atLeastOne(o.repeats.value_or(shape.repeats), "--repeats");
    checkDuration(2.0 * shape.repeats * glm::distance(shape.from, shape.to) / shape.speed, o.rate);
    return formulaMotion(shape, o.rate);
  }
  devices::InsertPath shape;
  double way = 0.0;
  for (const std::string& text : o.insert) {
    shape.points.push_back(point(text, "--insert"));
    if (shape.points.size() > 1) {
      way += glm::distance(shape.points.back(), shape.points[shape.points.size() - 2]);
    }
  }
  shape.speed = speed(shape.speed);
  shape.hold = notNegative(o.hold.value_or(shape.hold), "--hold");
  shape.back = o.back;
  checkDuration(2.0 * way / shape.speed + shape.hold, o.rate);
  return formulaMotion(shape, o.rate);
}

double nominalPeriod(const devices::Path& path, double rate) {
  std::vector<double> steps;
  steps.reserve(path.size());
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double step = path[i].t - path[i - 1].t;
    if (step > 0.0 && std::isfinite(step)) steps.push_back(step);
  }
  if (steps.empty()) return 1.0 / rate;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace palpate::tools
