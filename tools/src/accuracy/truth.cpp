#include "accuracy/truth.h"

#include <cmath>

#include "palpate/fields/foot_point.h"

namespace palpate::tools {
namespace {

constexpr double kOneDegree = 0.017453292519943295;
constexpr int kHalvings = 12;

double angleBetween(const Vec3& a, const Vec3& b) noexcept {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Bisects the segment, always keeping the half in which the gradient turns more.
bool bendsBetween(const Field& field, Vec3 a, Vec3 at_a, Vec3 b, double voxel) noexcept {
  Vec3 at_b = field.sample(b).gradient;
  double turn = angleBetween(at_a, at_b);
  double length = glm::length(b - a);
  for (int i = 0; i < kHalvings; ++i) {
    if (turn < kOneDegree) return false;
    if (length <= 0.5 * voxel && turn > length / (kTightestBend * voxel)) return true;
    const Vec3 middle = 0.5 * (a + b);
    const Vec3 at_middle = field.sample(middle).gradient;
    const double first = angleBetween(at_a, at_middle);
    const double second = angleBetween(at_middle, at_b);
    if (first > second) {
      b = middle;
      at_b = at_middle;
    } else {
      a = middle;
      at_a = at_middle;
    }
    turn = std::fmax(first, second);
    length *= 0.5;
  }
  return turn > kOneDegree;
}

}  // namespace

double meanCurvature(const FieldJet& jet) noexcept {
  const double slope = glm::length(jet.gradient);
  if (!(slope > 0.0)) return 0.0;
  const Vec3 n = jet.gradient / slope;
  const double trace = jet.hessian[0][0] + jet.hessian[1][1] + jet.hessian[2][2];
  return 0.5 * (trace - glm::dot(n, jet.hessian * n)) / slope;
}

std::optional<TruePoint> Truth::at(const Vec3& p) const noexcept {
  if (!projects_) {
    const FieldJet jet = field_->jet(p);
    const double slope = glm::length(jet.gradient);
    if (!jet.in_band || !(slope > 0.0)) return std::nullopt;
    return TruePoint{jet.value, jet.gradient / slope, meanCurvature(jet)};
  }
  const auto foot = footPoint(*field_, p);
  if (!foot) return std::nullopt;
  // Each principal curvature k becomes k / (1 + k d) at the distance d.
  const double d = foot->distance;
  const double sum = foot->curvature_sum;
  const double product = foot->curvature_product;
  return TruePoint{d, foot->normal,
                   0.5 * (sum + 2.0 * d * product) / (1.0 + d * sum + d * d * product)};
}

std::optional<Vec3> Truth::onSurface(const Vec3& p) const noexcept {
  Vec3 x = p;
  for (int i = 0; i < 20; ++i) {
    const FieldSample s = field_->sample(x);
    const double slope2 = glm::dot(s.gradient, s.gradient);
    if (!s.in_band || !(slope2 > 0.0)) return std::nullopt;
    const Vec3 step = (s.value / slope2) * s.gradient;
    x -= step;
    if (glm::length(step) <= 1e-14 * (glm::length(x) + field_->featureSize())) return x;
  }
  return std::nullopt;
}

bool isSmoothAround(const Field& field, const Vec3& p, double voxel) noexcept {
  const Vec3 here = field.sample(p).gradient;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3 end = p + kStencilReach * voxel * Vec3(x, y, z);
        if (bendsBetween(field, p, here, end, voxel)) return false;
      }
    }
  }
  return true;
}

}  // namespace palpate::tools
