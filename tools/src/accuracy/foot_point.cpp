#include "accuracy/foot_point.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

namespace palpate::tools {
namespace {

constexpr int kMostSteps = 30;

/// Whether another part of the surface is nearer to `p` than `distance` [m].
bool isNearerElsewhere(const Field& field, const Vec3& p, double distance) noexcept {
  // Nothing fits between the surface and a point on it, but rounding would see something there.
  if (std::fabs(distance) < 1e-9 * field.featureSize()) return false;
  const double radius = 0.99 * std::fabs(distance);
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3 at = p + radius * glm::normalize(Vec3(x, y, z));
        if (field.value(at) * distance < 0.0) return true;
      }
    }
  }
  return false;
}

/// The foot's normal and curvatures, from the field there.
FootPoint describe(const Vec3& p, const Vec3& foot, const FieldJet& jet) noexcept {
  FootPoint out;
  out.point = foot;
  const double slope = glm::length(jet.gradient);
  out.normal = jet.gradient / slope;
  out.distance = glm::dot(p - foot, out.normal);
  // The shape operator: the Hessian across the normal, by the slope.
  const Mat3 across = Mat3(1.0) - outer(out.normal, out.normal);
  const Mat3 shape = across * (jet.hessian / slope) * across;
  const Mat3 squared = shape * shape;
  out.curvature_sum = shape[0][0] + shape[1][1] + shape[2][2];
  out.curvature_product = 0.5 * (out.curvature_sum * out.curvature_sum -
                                 (squared[0][0] + squared[1][1] + squared[2][2]));
  return out;
}

/// Moving from the foot along the normal scales the surface's two directions by 1 + curvature *
/// distance; at p both are still positive.
bool isBeforeTheCentre(const FootPoint& foot) noexcept {
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
  // Steps no longer than this, so that a bad start does not leap onto another part.
  const double leash = 2.0 * std::fabs(here.value) / std::sqrt(slope2);
  // The step after one this short is rounding only: convergence is quadratic.
  const double enough =
      1e-13 * std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z), field.featureSize()});
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
    const double share = length > leash && length > 0.0 ? leash / length : 1.0;
    x += share * step;
    lambda += share * change;
    if (length > enough) continue;
    const FootPoint foot = describe(p, x, field.jet(x));
    if (!isBeforeTheCentre(foot) || isNearerElsewhere(field, p, foot.distance)) return std::nullopt;
    return foot;
  }
  return std::nullopt;
}

}  // namespace palpate::tools
