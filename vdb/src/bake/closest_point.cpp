#include "bake/closest_point.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::vdb {
namespace {

constexpr int kMostLooks = 6;
constexpr int kModelSteps = 8;
constexpr int kCreeps = 2;
// In voxels.
constexpr double kLeash = 1.5;     ///< longest single step
constexpr double kFarthest = 2.5;  ///< farthest from the start
/// A step this short needs no other: the next one would be of the order of its square
constexpr double kModelEnough = 3e-4;
constexpr double kOnSurface = 1e-5;
/// [voxels] A step along the surface has to gain more than this
constexpr double kLeastGain = 2e-3;
/// [voxels] After a step of length s, a surface of curvature k leaves an error of about k^2 s^3 /
/// 6, if its curvature changes as fast as its direction does; where the surface looks flat,
/// kLeastBend stands for its curvature. The error may be kMostLeft, or a tenth of the 0.037 k^3 by
/// which a cubic spline is off for such a curvature.
constexpr double kMostLeft = 1e-6;
constexpr double kShareLeft = 0.0037;
constexpr double kMostAnywhere = 1e-3;
constexpr double kLeastBend = 0.03;

/// Two vectors at right angles to `n` and to each other; not of unit length.
std::pair<Vec3, Vec3> across(const Vec3& n) noexcept {
  const Vec3 size = glm::abs(n);
  const bool by_x = size.x <= size.y && size.x <= size.z;
  const Vec3 u = by_x               ? Vec3(0.0, n.z, -n.y)
                 : size.y <= size.z ? Vec3(-n.z, 0.0, n.x)
                                    : Vec3(n.y, -n.x, 0.0);
  return {u, glm::cross(n, u)};
}

/// The vector from the place of the jet to the point closest to `p` on the zero set of the
/// quadratic model s + g e + e H e / 2; `apart` is `p` seen from that place.
std::optional<Vec3> onModel(const FieldJet& jet, const Vec3& apart, double voxel) noexcept {
  Vec3 e(0.0);
  for (int step = 0; step < kModelSteps; ++step) {
    const Vec3 bent = jet.hessian * e;
    const Vec3 g = jet.gradient + bent;
    const double square = glm::dot(g, g);
    if (!(square > 0.0)) return std::nullopt;
    const double s = jet.value + glm::dot(jet.gradient, e) + 0.5 * glm::dot(e, bent);
    const Vec3 rest = apart - e;
    const double lambda = glm::dot(rest, g) / square;
    // Solve along the normal and in the tangent plane: how the field curves across the surface does
    // not matter.
    const Vec3 down = (-s / square) * g;
    const auto [u, v] = across(g);
    const Mat3 hessian = jet.hessian * lambda;
    const Vec3 bent_u = u + hessian * u;
    const Vec3 bent_v = v + hessian * v;
    const double uu = glm::dot(u, bent_u);
    const double uv = glm::dot(u, bent_v);
    const double vv = glm::dot(v, bent_v);
    const double size = uu * vv - uv * uv;
    const double flat = glm::dot(u, u) * glm::dot(v, v);
    // Beyond a center of curvature the matrix is indefinite; there the step goes to the point on
    // the tangent plane.
    Vec3 move = rest - lambda * g + down;
    if (uu > 0.0 && size > 1e-3 * flat) {
      const Vec3 pull = rest - down - hessian * down;
      const double a = glm::dot(u, pull);
      const double b = glm::dot(v, pull);
      move = down + ((vv * a - uv * b) / size) * u + ((uu * b - uv * a) / size) * v;
    }
    const double length = glm::length(move);
    if (!std::isfinite(length)) return std::nullopt;
    e += move * std::min(1.0, voxel / length);
    if (length < kModelEnough * voxel) return e;
    if (glm::length(e) > kLeash * voxel) return e * (kLeash * voxel / glm::length(e));
  }
  return e;
}

/// Whether a step of the model is short enough that the error it leaves does not matter.
bool isEnough(const FieldJet& jet, double step, double voxel) noexcept {
  double square = 0.0;
  for (int column = 0; column < 3; ++column) {
    square += glm::dot(jet.hessian[column], jet.hessian[column]);
  }
  const double slope2 = glm::dot(jet.gradient, jet.gradient);
  const double bend = std::max(std::sqrt(square / slope2) * voxel, kLeastBend);
  const double s = step / voxel;
  return bend * bend * s * s * s / 6.0 <
         std::clamp(kShareLeft * bend * bend * bend, kMostLeft, kMostAnywhere);
}

}  // namespace

std::optional<Vec3> ClosestPoint::of(const Vec3& p, const Vec3& start) const noexcept {
  return from(p, start, field_.jet(start));
}

std::optional<Vec3> ClosestPoint::from(const Vec3& p, const Vec3& start,
                                       const FieldJet& at_start) const noexcept {
  Vec3 x = start;
  double last = kInfinity;
  for (int look = 0; look < kMostLooks; ++look) {
    const FieldJet jet = look == 0 ? at_start : field_.jet(x);
    if (!jet.in_band) return std::nullopt;
    const std::optional<Vec3> step = onModel(jet, p - x, voxel_);
    if (!step) return std::nullopt;
    x += *step;
    const double length = glm::length(*step);
    if (isEnough(jet, length, voxel_)) return x;
    const Vec3 way = x - start;
    if (!(glm::dot(way, way) < kFarthest * kFarthest * voxel_ * voxel_)) return std::nullopt;
    if (look >= 2 && length > 0.5 * last) return std::nullopt;
    last = length;
  }
  return std::nullopt;
}

std::optional<Vec3> ClosestPoint::onto(const Vec3& start) const noexcept {
  Vec3 x = start;
  for (int look = 0; look < kMostLooks; ++look) {
    const FieldSample s = field_.sample(x);
    const double square = glm::dot(s.gradient, s.gradient);
    if (!s.in_band || !(square > 0.0)) return std::nullopt;
    const Vec3 by = (s.value / square) * s.gradient;
    const double length = glm::length(by);
    if (!(length < kLeash * voxel_)) return std::nullopt;
    x -= by;
    if (length < kOnSurface * voxel_) return x;
    const Vec3 way = x - start;
    if (!(glm::dot(way, way) < kFarthest * kFarthest * voxel_ * voxel_)) return std::nullopt;
  }
  return std::nullopt;
}

Vec3 ClosestPoint::creptTo(const Vec3& p, const Vec3& foot) const noexcept {
  Vec3 best = foot;
  double share = 1.0;
  for (int creep = 0; creep < kCreeps; ++creep) {
    const FieldSample here = field_.sample(best);
    const double square = glm::dot(here.gradient, here.gradient);
    if (!here.in_band || !(square > 0.0)) return best;
    const Vec3 apart = p - best;
    Vec3 along = apart - (glm::dot(apart, here.gradient) / square) * here.gradient;
    const double length = glm::length(along);
    // On a tangent plane the step would gain length^2 / (2 |apart|).
    const double gain = 0.5 * length * length / std::max(glm::length(apart), voxel_);
    if (!(gain > kLeastGain * voxel_)) return best;
    along *= share * std::min(1.0, 0.5 * voxel_ / length);
    const std::optional<Vec3> next = onto(best + along);
    const Vec3 left = next ? p - *next : Vec3(kInfinity);
    if (glm::dot(left, left) < glm::dot(apart, apart)) {
      best = *next;
    } else {
      share *= 0.4;
    }
  }
  return best;
}

}  // namespace palpate::vdb
