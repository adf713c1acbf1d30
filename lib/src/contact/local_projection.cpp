#include "palpate/contact/local_projection.h"

#include <algorithm>
#include <cmath>

#include "palpate/contact/planes.h"

namespace palpate {
namespace {

constexpr int kMostLooks = 40;
constexpr double kLeastEigenvalue = 0.02;
constexpr double kLargestTurn = 0.5;  // [rad]
/// Relative to the way to the target and to the coordinates: a step this short means convergence.
constexpr double kSettled = 1e-12;
constexpr double kRounding = 1e-14;
/// Relative to the way: if steps no longer get shorter, a step this short means convergence. A wall
/// whose shape is given about a far place has larger rounding errors than the coordinates.
constexpr double kSettledAtLast = 1e-8;

}  // namespace

LocalProjection projectLocally(const Vec3& from, const Vec3& target,
                               std::span<const HeldWall> walls) noexcept {
  LocalProjection out;
  out.at = from;
  const std::size_t count = std::min(walls.size(), kMaxProjectionWalls);
  double last = kInfinity;
  double share = 1.0;
  for (int look = 0; look < kMostLooks; ++look) {
    std::array<Plane, kMaxProjectionWalls> planes{};
    std::array<FieldJet, kMaxProjectionWalls> jets{};
    std::array<double, kMaxProjectionWalls> slopes{};
    for (std::size_t i = 0; i < count; ++i) {
      jets[i] = walls[i].field->jet(out.at);
      slopes[i] = glm::length(jets[i].gradient);
      if (!jets[i].in_band || !(slopes[i] > 0.0)) return out;
      const double side = walls[i].side / slopes[i];
      planes[i] = {side * jets[i].gradient, side * jets[i].value};
    }
    const Vec3 wish = target - out.at;
    const std::span<const Plane> given(planes.data(), count);
    const PlaneSolution solution = closestStep(wish, given);
    Mat3 bend(0.0);
    double turns = 0.0;
    out.count = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(solution.count); ++k) {
      const auto i = static_cast<std::size_t>(solution.plane[k]);
      const double scale = walls[i].side / slopes[i];
      bend += (solution.multiplier[k] * scale) * jets[i].hessian;
      HeldWall& held = out.held[out.count++];
      held = walls[i];
      held.jet = jets[i];
      held.normal = planes[i].normal;
      held.multiplier = solution.multiplier[k];
    }
    Vec3 step = curvedStep(wish, given, solution, bend, kLeastEigenvalue).step;
    for (std::size_t k = 0; k < out.count; ++k) {
      turns = std::max(turns, glm::length(out.held[k].jet.hessian * step) /
                                  glm::length(out.held[k].jet.gradient));
    }
    if (turns > kLargestTurn) step *= kLargestTurn / turns;
    const double length = glm::length(step);
    const double size = std::max({std::fabs(out.at.x), std::fabs(out.at.y), std::fabs(out.at.z)});
    if (!std::isfinite(length)) return out;
    const double way = glm::length(wish);
    if (length <= kSettled * way + kRounding * size ||
        (length <= kSettledAtLast * way && length > 0.5 * last)) {
      out.settled = true;
      return out;
    }
    // Between two faces of one kind full steps may alternate for ever, so the step is damped; a
    // step that was shortened because it turned too far is not evidence of that.
    if (turns <= kLargestTurn) {
      share = length > 0.9 * last ? std::max(0.25, 0.5 * share) : std::min(1.0, 2.0 * share);
      last = length;
    }
    out.at += share * step;
  }
  return out;
}

}  // namespace palpate
