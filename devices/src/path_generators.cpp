#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/devices/path.h"

namespace palpate::devices {
namespace {

constexpr double kMostRows = 1e8;

void require(bool good, const std::string& what, double value) {
  if (good) return;
  throw inputError("path.parameter", what + ", not " + std::to_string(value));
}

void requirePositive(const char* name, double value) {
  require(std::isfinite(value) && value > 0.0, std::string(name) + " must be finite and above 0",
          value);
}

void requireNotNegative(const char* name, double value) {
  require(std::isfinite(value) && value >= 0.0, std::string(name) + " must be finite and 0 or more",
          value);
}

void requireFinite(const char* name, const Vec3& value) {
  if (isFinite(value)) return;
  throw inputError("path.parameter", std::string(name) + " has a coordinate that is not finite");
}

Vec3 unitNormal(const Vec3& normal) {
  requireFinite("normal", normal);
  const double length = glm::length(normal);
  require(length > 0.0 && std::isfinite(length), "normal must have a direction; its length is",
          length);
  return normal / length;
}

/// a + u (b - a), exactly a at 0 and b at 1.
Vec3 between(const Vec3& a, const Vec3& b, double u) {
  if (u <= 0.0) return a;
  if (u >= 1.0) return b;
  return u < 0.5 ? a + u * (b - a) : b - (1.0 - u) * (b - a);
}

/// Samples `position(t)` at t = i / rate until `duration` has passed; the last row is `end`.
PathFormula sampled(double duration, double rate, const Vec3& end,
                    std::function<Vec3(double)> position) {
  requirePositive("rate", rate);
  const double exact = duration * rate;
  // Rounding must not add a tick to a duration that is a whole number of ticks.
  const double last = std::max(1.0, std::ceil(exact * (1.0 - 1e-12)));
  if (!(last < kMostRows)) {
    throw inputError(
        "path.parameter",
        "the path would have " + std::to_string(last) + " rows; at most 10^8 are possible",
        "lower the rate, or raise the speed");
  }
  return {static_cast<std::size_t>(last), rate, end, std::move(position)};
}

Path rowsOf(const PathFormula& formula) {
  Path path;
  path.reserve(formula.size());
  for (std::size_t i = 0; i < formula.size(); ++i) path.push_back(formula.at(i));
  return path;
}

/// A polyline with its arc lengths.
class Polyline {
 public:
  explicit Polyline(std::vector<Vec3> points) : points_(std::move(points)) {
    arc_.reserve(points_.size());
    arc_.push_back(0.0);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      arc_.push_back(arc_.back() + glm::length(points_[i] - points_[i - 1]));
    }
  }
  [[nodiscard]] double length() const { return arc_.back(); }
  [[nodiscard]] const Vec3& front() const { return points_.front(); }
  [[nodiscard]] const Vec3& back() const { return points_.back(); }

  [[nodiscard]] Vec3 at(double s) const {
    if (s <= 0.0) return points_.front();
    if (s >= length()) return points_.back();
    const auto next = std::upper_bound(arc_.begin(), arc_.end(), s);
    const auto i = static_cast<std::size_t>(next - arc_.begin());  // arc_[i - 1] <= s < arc_[i]
    return between(points_[i - 1], points_[i], (s - arc_[i - 1]) / (arc_[i] - arc_[i - 1]));
  }

 private:
  std::vector<Vec3> points_;
  std::vector<double> arc_;
};

/// A path there, with a hold, and back if `back`.
PathFormula traverse(const Polyline& line, double speed, double hold, bool back, double rate) {
  requirePositive("speed", speed);
  requireNotNegative("hold", hold);
  const double there = line.length() / speed;
  const double duration = there + hold + (back ? there : 0.0);
  return sampled(duration, rate, back ? line.front() : line.back(), [=](double t) {
    if (t <= there) return line.at(speed * t);
    if (t <= there + hold || !back) return line.back();
    return line.at(line.length() - speed * (t - there - hold));
  });
}

}  // namespace

PathFormula formula(const PressPath& shape, double rate) {
  requireFinite("surface", shape.surface);
  const Vec3 normal = unitNormal(shape.normal);
  requireNotNegative("depth", shape.depth);
  requireNotNegative("clearance", shape.clearance);
  const Vec3 start = shape.surface + shape.clearance * normal;
  const Vec3 deepest = shape.surface - shape.depth * normal;
  const Polyline line({start, deepest});
  require(line.length() > 0.0, "depth and clearance together must be above 0", line.length());
  return traverse(line, shape.speed, shape.hold, true, rate);
}

PathFormula formula(const StrokePath& shape, double rate) {
  requireFinite("from", shape.from);
  requireFinite("to", shape.to);
  requirePositive("speed", shape.speed);
  require(shape.repeats >= 1, "repeats must be 1 or more", shape.repeats);
  const double length = glm::length(shape.to - shape.from);
  require(length > 0.0 && std::isfinite(length), "`from` and `to` must be apart; they are [m]",
          length);
  const double duration = 2.0 * length * shape.repeats / shape.speed;
  return sampled(duration, rate, shape.from, [shape, length](double t) {
    const double along = std::fmod(shape.speed * t, 2.0 * length);
    return between(shape.from, shape.to, std::min(along, 2.0 * length - along) / length);
  });
}

PathFormula formula(const TapPath& shape, double rate) {
  requireFinite("surface", shape.surface);
  const Vec3 normal = unitNormal(shape.normal);
  requireNotNegative("depth", shape.depth);
  requireNotNegative("clearance", shape.clearance);
  requirePositive("frequency", shape.frequency);
  require(shape.taps >= 1, "taps must be 1 or more", shape.taps);
  const double mean = 0.5 * (shape.clearance - shape.depth);
  const double amplitude = 0.5 * (shape.clearance + shape.depth);
  require(amplitude > 0.0, "depth and clearance together must be above 0", amplitude);
  const Vec3 rest = shape.surface + shape.clearance * normal;
  return sampled(shape.taps / shape.frequency, rate, rest, [=](double t) {
    const double cycles = shape.frequency * t;
    const double phase = 2.0 * std::numbers::pi * (cycles - std::floor(cycles));
    return shape.surface + (mean + amplitude * std::cos(phase)) * normal;
  });
}

PathFormula formula(const InsertPath& shape, double rate) {
  require(shape.points.size() >= 2, "an insertion needs two points or more",
          static_cast<double>(shape.points.size()));
  for (const Vec3& point : shape.points) requireFinite("points", point);
  const Polyline line(shape.points);
  require(line.length() > 0.0, "the way points must not all be the same; the way is [m]",
          line.length());
  return traverse(line, shape.speed, shape.hold, shape.back, rate);
}

Path generate(const PressPath& shape, double rate) { return rowsOf(formula(shape, rate)); }
Path generate(const StrokePath& shape, double rate) { return rowsOf(formula(shape, rate)); }
Path generate(const TapPath& shape, double rate) { return rowsOf(formula(shape, rate)); }
Path generate(const InsertPath& shape, double rate) { return rowsOf(formula(shape, rate)); }

}  // namespace palpate::devices
