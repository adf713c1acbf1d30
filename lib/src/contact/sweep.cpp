#include "palpate/contact/sweep.h"

#include <algorithm>

namespace palpate {
namespace {

/// Sine of the angle to the surface below which a motion counts as parallel to it.
constexpr double kAlong = 1e-12;

/// The motion along one segment.
struct Motion {
  const SweepSurface& surface;
  Vec3 from;
  Vec3 by;
  double length;
  int budget;

  [[nodiscard]] double valueAt(double t) noexcept {
    --budget;
    return surface.side * surface.field->value(from + t * by) + surface.allowance;
  }
};

/// Narrows the bracket of a sign change down to the tolerance. Secant steps aim at half of the
/// tolerance on the near side, so that one good step ends the search. If the same end stays twice,
/// its value is halved (the Illinois rule), and every fourth step halves the bracket, so that the
/// search makes progress for any shape of S. Returns the near end.
double narrow(Motion& motion, double near, double near_value, double far,
              double far_value) noexcept {
  const double tolerance = motion.surface.tolerance;
  const double aim = 0.5 * tolerance;
  const double shortest = 1e-15;
  double near_weight = near_value - aim;
  double far_weight = far_value - aim;
  int moved = 0;  // +1: the near end, -1: the far end
  for (int i = 0; i < 60 && near_value > tolerance && far - near > shortest; ++i) {
    double t = near + (far - near) * near_weight / (near_weight - far_weight);
    if (i % 4 == 3) t = 0.5 * (near + far);
    t = std::clamp(t, near, far);
    const double value = motion.valueAt(t);
    if (value > 0.0) {
      near = t;
      near_value = value;
      near_weight = value - aim;
      if (moved > 0) far_weight *= 0.5;
      moved = 1;
    } else {
      far = t;
      far_weight = value - aim;
      if (moved < 0) near_weight *= 0.5;
      moved = -1;
    }
  }
  return near;
}

}  // namespace

SweepResult sweep(const SweepSurface& surface, const Vec3& a, const Vec3& b, double start,
                  int budget) noexcept {
  Motion motion{surface, a, b - a, glm::length(b - a), budget};
  SweepResult out;
  if (motion.length <= 0.0) {
    out.end_value = start;
    return out;
  }
  const double reach = surface.lipschitz * motion.length;
  if (start > reach) {
    out.end_value = start - reach;
    return out;
  }
  const double end = motion.valueAt(1.0);
  // If the values at both ends together exceed the Lipschitz bound of the whole segment, there is
  // no crossing between them; nor is there one if both ends are on the same side of a plane.
  if (start > surface.tolerance && end > surface.tolerance &&
      (surface.is_flat || start + end >= reach)) {
    out.end_value = end;
    return out;
  }

  double t = 0.0;
  double value = start;
  double stride = surface.graze;
  if (start <= surface.tolerance) {
    const double slope = surface.side * glm::dot(surface.field->sample(a).gradient, motion.by);
    --motion.budget;
    // A motion along the surface, within rounding, does not count as a hit here: the steps below
    // decide.
    if (slope < -kAlong * reach) return {SweepResult::Kind::kHit, 0.0, start};
    if (surface.is_flat && end > surface.tolerance) return {SweepResult::Kind::kFree, 1.0, end};
    // The motion leaves the surface: begin with tiny steps, so that a fold close by is not skipped.
    stride = std::min(surface.graze, 8.0 * surface.tolerance / surface.lipschitz);
  }
  const double shortest_share = 1.0 / motion.length;
  while (motion.budget > 0) {
    const double step = std::max(value / reach, stride * shortest_share);
    stride = std::min(2.0 * stride, surface.graze);
    const double next = std::min(1.0, t + step);
    const double ahead = next >= 1.0 ? end : motion.valueAt(next);
    // A start slightly beyond the surface is on its way back; there only a motion that goes deeper
    // is a hit.
    const double deeper = std::min(0.0, value) - surface.tolerance;
    if (ahead <= 0.0 && (value > surface.tolerance || ahead < deeper)) {
      out.kind = SweepResult::Kind::kHit;
      out.at = value > surface.tolerance ? narrow(motion, t, value, next, ahead) : t;
      out.end_value = 0.0;
      return out;
    }
    t = next;
    value = ahead;
    if (t >= 1.0) {
      out.end_value = end;
      return out;
    }
  }
  return {SweepResult::Kind::kUnsure, t, value};
}

}  // namespace palpate
