#include "plant_axis.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "plant_matrix.h"

namespace palpate::devices {
namespace {

constexpr std::size_t kSize = plant::kSize;

/// A slower speed counts as rest: 1e-12 m/s is 1e-15 m in a millisecond. Without this limit a
/// device that, by rounding, seems to slide back and forth would never make progress.
constexpr double kStill = 1e-12;
/// The same for a force, as a share of the friction.
constexpr double kLetsGo = 1e-12;
/// The most events in one call. Real motion has a few; beyond this friction holds until the next
/// call.
constexpr int kMostEvents = 64;
/// The most searches (each halves a step repeatedly) that are expected between two events. If
/// friction and force are equal except for rounding, more may occur and find nothing: then each
/// further search lowers the finest level by one, down to kLeastDepth, and what still seems to be
/// an event at that level counts as one.
constexpr int kMostLooks = 96;
constexpr int kLeastDepth = 8;

double dot(const PlantState& row, const PlantState& state) noexcept {
  double sum = 0.0;
  for (std::size_t j = 0; j < kSize; ++j) sum += row[j] * state[j];
  return sum;
}

double form(const std::array<double, 81>& matrix, const PlantState& state) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < kSize; ++i) {
    double row = 0.0;
    for (std::size_t j = 0; j < kSize; ++j) row += matrix[kSize * i + j] * state[j];
    sum += state[i] * row;
  }
  return sum;
}

PlantState after(const PlantStep& step, const PlantState& state, double length) noexcept {
  PlantState next = state;
  for (std::size_t i = 0; i < plant::kPath; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < kSize; ++j) sum += step.next[kSize * i + j] * state[j];
    next[i] = sum;
  }
  next[plant::kPath] += length * state[plant::kPathRate];
  return next;
}

/// Whether a function with these values and slopes at the ends of `length` goes below zero: at the
/// end, or before it if the slope changes sign. It is assumed to do so at most once.
bool mayCross(double after, double before, double slope_before, double slope_after,
              double length) noexcept {
  if (after < 0.0) return true;
  if (slope_before >= 0.0 || slope_after <= 0.0) return false;
  // If it is convex, it lies above both tangents.
  return before + slope_before * length < 0.0 && after - slope_after * length < 0.0;
}

}  // namespace

void PlantAxis::start(double x, double push, double damping) noexcept {
  *this = {};
  push_ = push;
  damping_ = damping;
  state_[plant::kX] = x;
  state_[plant::kHandX] = x;
  state_[plant::kConstant] = push;
}

double PlantAxis::netForce(const PlantTables& tables) const noexcept {
  PlantState bare = state_;
  bare[plant::kConstant] = push_;
  return tables.mass * dot(tables.acceleration, bare);
}

void PlantAxis::slide(const PlantTables& tables, int way) noexcept {
  way_ = way;
  state_[plant::kConstant] = push_ - way * tables.friction;
}

/// At rest: decides whether it sticks, or in which direction it slides.
void PlantAxis::setWay(const PlantTables& tables) noexcept {
  const double force = netForce(tables);
  const bool lets_go = std::fabs(force) > tables.friction * (1.0 + kLetsGo);
  slide(tables, !lets_go ? 0 : force > 0.0 ? 1 : -1);
}

bool PlantAxis::hasEvent(const PlantTables& tables, const PlantState& next,
                         double length) const noexcept {
  if (way_ != 0) {
    return mayCross(way_ * next[plant::kV] + kStill, way_ * state_[plant::kV] + kStill,
                    way_ * dot(tables.acceleration, state_), way_ * dot(tables.acceleration, next),
                    length);
  }
  // While it sticks, the constant is the push alone, without friction.
  const double force = tables.mass * dot(tables.acceleration, state_);
  const double force_after = tables.mass * dot(tables.acceleration, next);
  const double most = tables.friction * (1.0 + kLetsGo);
  const double rate = tables.mass * dot(tables.jerk, state_);
  const double rate_after = tables.mass * dot(tables.jerk, next);
  return mayCross(most - force_after, most - force, -rate, -rate_after, length) ||
         mayCross(most + force_after, most + force, rate, rate_after, length);
}

void PlantAxis::take(const PlantStep& step, const PlantTables& tables,
                     const PlantState& next) noexcept {
  const double way = next[plant::kX] - state_[plant::kX];
  work_.motor += tables.has_lag ? form(step.power, state_) : state_[plant::kForce] * way;
  if (damping_ > 0.0) work_.viscous += damping_ * form(step.speed, state_);
  work_.push += push_ * way;
  work_.friction += tables.friction * std::fabs(way);
  state_ = next;
}

void PlantAxis::advance(const PlantTables& tables, const Inputs& inputs,
                        std::int64_t quanta) noexcept {
  state_[plant::kCommand] = inputs.force;
  if (!tables.has_lag) state_[plant::kForce] = inputs.force;
  state_[plant::kPath] = inputs.path;
  state_[plant::kPathRate] = inputs.path_rate;
  const bool has_friction = tables.friction > 0.0;
  if (has_friction && way_ == 0) setWay(tables);

  int events = 0;
  int looks_in_vain = 0;  // since the last event
  int finest = 0;         // level of the longest step worth trying: a longer one contained an event
  while (quanta > 0) {
    int level = finest;
    while (PlantTables::kLongest >> level > quanta) ++level;
    const auto& steps = has_friction && way_ == 0 ? tables.sticking : tables.moving;
    double length = tables.quantum * static_cast<double>(PlantTables::kLongest >> level);
    PlantState next = after(steps[static_cast<std::size_t>(level)], state_, length);
    const bool looks = has_friction && events < kMostEvents;
    bool is_event = looks && hasEvent(tables, next, length);
    if (is_event) ++looks_in_vain;
    const int depth =
        std::max(PlantTables::kDepth - std::max(looks_in_vain - kMostLooks, 0), kLeastDepth);
    while (is_event && level < depth) {
      ++level;
      length *= 0.5;
      next = after(steps[static_cast<std::size_t>(level)], state_, length);
      is_event = hasEvent(tables, next, length);
      finest = level;
    }
    take(steps[static_cast<std::size_t>(level)], tables, next);
    quanta -= PlantTables::kLongest >> level;
    finest = std::max(0, finest - 1);
    if (!is_event) continue;
    finest = 0;
    looks_in_vain = 0;
    ++events;
    state_[plant::kV] = 0.0;
    setWay(tables);
    if (events == kMostEvents) slide(tables, 0);
  }
}

}  // namespace palpate::devices
