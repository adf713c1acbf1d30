#include "palpate/fields/foot_point.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

namespace palpate {
namespace {

constexpr int kMostSteps = 20;
constexpr int kFreeSteps = 4;  ///< after these each step must be less than half of the one before

/// Whether another part of the surface is nearer to `p` than `distance` [m].
bool isNearerElsewhere(const Field& field, const Vec3& p, double distance) noexcept {
  // Nothing fits between the surface and a point on it, but rounding would find something there.
  if (std::fabs(distance) < 1e-9 * field.featureSize()) return false;
  const auto is_beyond = [&](const Vec3& direction) {
    return field.value(p + 0.99 * std::fabs(distance) * direction) * distance < 0.0;
  };
  constexpr double kDiagonal = 0.57735026918962576;
  for (int n = 0; n < 8; ++n) {
    const Vec3 corner((n & 4) != 0 ? 1.0 : -1.0, (n & 2) != 0 ? 1.0 : -1.0,
                      (n & 1) != 0 ? 1.0 : -1.0);
    if (is_beyond(kDiagonal * corner)) return true;
  }
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 along(0.0);
    along[axis] = 1.0;
    if (is_beyond(along) || is_beyond(-along)) return true;
  }
  return false;
}

/// The foot's normal and curvatures, from the field's jet at the foot.
FootPoint describe(const Vec3& p, const Vec3& foot, const FieldJet& jet) noexcept {
  FootPoint out;
  out.point = foot;
  const double slope = glm::length(jet.gradient);
  out.normal = jet.gradient / slope;
  out.distance = glm::dot(p - foot, out.normal);
  // The shape operator: the tangential part of the Hessian, divided by the slope.
  const Mat3 across = Mat3(1.0) - outer(out.normal, out.normal);
  const Mat3 shape = across * (jet.hessian / slope) * across;
  const Mat3 squared = shape * shape;
  out.curvature_sum = shape[0][0] + shape[1][1] + shape[2][2];
  out.curvature_product = 0.5 * (out.curvature_sum * out.curvature_sum -
                                 (squared[0][0] + squared[1][1] + squared[2][2]));
  return out;
}

/// Moving from the foot along the normal scales the surface's two principal directions by 1 +
/// curvature * distance; p lies before the center of curvature if both factors are still positive
/// at p.
bool isBeforeTheCenter(const FootPoint& foot) noexcept {
  const double sum = foot.curvature_sum * foot.distance;
  const double product = foot.curvature_product * foot.distance * foot.distance;
  return 1.0 + sum + product > 0.0 && 2.0 + sum > 0.0;
}

}  // namespace

std::optional<FootPoint> footPoint(const Field& field, const Vec3& p) noexcept {
  const FieldSample here = field.sample(p);
  const double slope2 = glm::dot(here.gradient, here.gradient);
  if (!here.in_band || !(slope2 > 0.0)) return std::nullopt;
  double lambda = here.value / slope2;
  Vec3 x = p - lambda * here.gradient;
  // The longest step, so that a bad start does not jump to another part of the surface.
  const double leash = 2.0 * std::fabs(here.value) / std::sqrt(slope2);
  // Convergence is quadratic: after a step this short the next one is only rounding.
  const double enough =
      1e-13 * std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z), field.featureSize()});
  double last_length = kInfinity;
  for (int i = 0; i < kMostSteps; ++i) {
    const FieldJet jet = field.jet(x);
    if (!jet.in_band) return std::nullopt;
    const Vec3 rest = x - p + lambda * jet.gradient;
    const Mat3 bend = Mat3(1.0) + lambda * jet.hessian;
    if (std::fabs(glm::determinant(bend)) < 1e-12) return std::nullopt;
    const Mat3 inverse = glm::inverse(bend);
    const Vec3 along = inverse * jet.gradient;
    const double across = glm::dot(jet.gradient, along);
    if (!(std::fabs(across) > 0.0)) return std::nullopt;
    const double change = (jet.value - glm::dot(jet.gradient, inverse * rest)) / across;
    Vec3 step = -(inverse * (rest + change * jet.gradient));
    const double length = glm::length(step);
    if (!std::isfinite(length)) return std::nullopt;
    if (i >= kFreeSteps && length > enough && length > 0.5 * last_length) return std::nullopt;
    last_length = length;
    const double share = length > leash && length > 0.0 ? leash / length : 1.0;
    x += share * step;
    lambda += share * change;
    if (length > enough) continue;
    const FootPoint foot = describe(p, x, field.jet(x));
    if (!isBeforeTheCenter(foot) || isNearerElsewhere(field, p, foot.distance)) return std::nullopt;
    return foot;
  }
  return std::nullopt;
}

}  // namespace palpate
