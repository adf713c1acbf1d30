#include <algorithm>
#include <array>
#include <utility>

#include "fields/checks.h"
#include "fields/vector.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate {
namespace {

/// The closest point x of an ellipsoid to a point y satisfies y_i = x_i + tau x_i / e_i^2 for one
/// multiplier tau (Eberly 2013, section 2). With e_2 the smallest semi-axis and tau = s e_2^2:
///   w_i = y_i / (s + r_i),  x_i = r_i w_i,  y_i - x_i = s w_i,   where r_i = (e_i / e_2)^2,
/// so that w points along the outward normal and the signed distance is s |w|. The root is sought
/// in t = s + 1 >= 0, which keeps its digits near the medial disc, where s tends to -1.
struct Closest {
  double multiplier = 0.0;  ///< s [-]
  Vec3 w{0.0, 0.0, 0.0};    ///< [m] in sorted axes, all components >= 0
};

class Ellipsoid final : public Field {
 public:
  Ellipsoid(const Vec3& center, const Vec3& radii) : center_(center), radii_(radii) {
    std::sort(order_.begin(), order_.end(),
              [&](int a, int b) { return radii[a] > radii[b] || (radii[a] == radii[b] && a < b); });
    for (int i = 0; i < 3; ++i) axes_[i] = radii[order_[static_cast<std::size_t>(i)]];
    const double least = axes_[2];
    for (int i = 0; i < 3; ++i) {
      excess_[i] = (axes_[i] - least) / least * ((axes_[i] + least) / least);
      scale_[i] = axes_[i] / least / least;
      const double ratio = least / radii[i];
      inverse_ratio_[i] = ratio * ratio;
    }
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    double normal_length = 0.0;
    return sampleAt(p - center_, normal_length);
  }

  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    double normal_length = 0.0;
    const FieldSample here = sampleAt(p - center_, normal_length);
    return {here.value, here.gradient, hessianOf(here, normal_length)};
  }

  [[nodiscard]] Box3 bounds() const noexcept override {
    return {center_ - radii_, center_ + radii_};
  }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kExact; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override {
    return axes_[2] * (axes_[2] / axes_[0]);  // radius of curvature at the end of the longest axis
  }

 private:
  /// `normal_length`: |w|, or 0 where the curvature no longer matters (very far away).
  [[nodiscard]] FieldSample sampleAt(const Vec3& d, double& normal_length) const noexcept {
    const Vec3 size = glm::abs(d);
    // At this distance the ellipsoid is a point to all sixteen digits (this also catches points
    // that are not finite).
    if (!(std::max({size.x, size.y, size.z}) <= 1e20 * axes_[0])) {
      const fields::Polar q = fields::polar(d, Vec3(1.0, 0.0, 0.0));
      return {q.length, q.direction};
    }
    const Closest closest = closestTo(Vec3(size[order_[0]], size[order_[1]], size[order_[2]]));
    const fields::Polar n = fields::polar(closest.w, Vec3(0.0, 0.0, 1.0));
    FieldSample out{closest.multiplier * n.length, Vec3(0.0)};
    for (int i = 0; i < 3; ++i) {
      const int axis = order_[static_cast<std::size_t>(i)];
      out.gradient[axis] = n.direction[i] * fields::side(d[axis]);
    }
    normal_length = n.length;
    return out;
  }

  /// Root of G(t) = sum (c_i / (t + excess_i))^2 = 1 by Newton's method on 1/sqrt(G) - 1, which is
  /// increasing and concave: steps that start left of the root never pass it.
  [[nodiscard]] Closest closestTo(const Vec3& y) const noexcept {
    Vec3 c = scale_ * y;  // r_i y_i / e_i
    bool has_pole = false;
    double at_zero = 0.0;
    for (int i = 0; i < 3; ++i) {
      if (excess_[i] > 0.0) {
        at_zero += (c[i] / excess_[i]) * (c[i] / excess_[i]);
      } else if (c[i] < 1e-140) {
        c[i] = 0.0;  // on the plane of the medial disc, to far below rounding
      } else {
        has_pole = true;
      }
    }
    if (!has_pole && at_zero <= 1.0) return onMedialDisc(y, at_zero);

    const double from_left = std::max(
        {c.x - excess_.x, c.y - excess_.y, c.z - excess_.z, glm::length(c) - excess_.x, 0.0});
    double t = from_left;
    // Usually 3 to 6 steps. The limit only guards against a cycle in the last digit.
    for (int iteration = 0; iteration < 100; ++iteration) {
      double sum = 0.0;
      double slope = 0.0;
      for (int i = 0; i < 3; ++i) {
        if (c[i] == 0.0) continue;
        const double q = c[i] / (t + excess_[i]);
        sum += q * q;
        slope += q * q / (t + excess_[i]);
      }
      const double excess = std::sqrt(sum) - 1.0;
      const double step = sum * excess / slope;
      t += step;
      if (!(step > 4e-16 * t) || !(excess > 4e-16)) break;
    }
    Closest out{t - 1.0, Vec3(0.0)};
    for (int i = 0; i < 3; ++i) {
      if (y[i] > 0.0) out.w[i] = y[i] / (t + excess_[i]);
    }
    return out;
  }

  /// Here two closest points face each other across the plane of the two longer axes.
  [[nodiscard]] Closest onMedialDisc(const Vec3& y, double sum) const noexcept {
    Closest out{-1.0, Vec3(0.0)};
    for (int i = 0; i < 2; ++i) {
      if (excess_[i] > 0.0) out.w[i] = y[i] / excess_[i];
    }
    out.w[2] = axes_[2] * std::sqrt(1.0 - sum);
    return out;
  }

  /// K (I + d K)^-1 in the tangent plane, K the curvature of the surface at the closest point.
  [[nodiscard]] Mat3 hessianOf(const FieldSample& here, double normal_length) const noexcept {
    if (!(normal_length > 0.0)) return fields::radialHessian(here.gradient, here.value);
    const Vec3 a = fields::perpendicularTo(here.gradient);
    const Vec3 b = glm::cross(here.gradient, a);
    const Vec3 bend = inverse_ratio_ / normal_length;
    const double aa = glm::dot(a, bend * a);
    const double ab = glm::dot(a, bend * b);
    const double bb = glm::dot(b, bend * b);
    const double determinant = aa * bb - ab * ab;
    const double d = here.value;
    // At a center of curvature the distance has no second derivative: stay finite there.
    const double spread = std::max(1.0 + d * (aa + bb) + d * d * determinant, 1e-12);
    const double shift = d * determinant;
    const Mat3 hessian =
        outer(a, a) * (aa + shift) + outer(b, b) * (bb + shift) + (outer(a, b) + outer(b, a)) * ab;
    return hessian * (1.0 / spread);
  }

  Vec3 center_;
  Vec3 radii_;
  std::array<int, 3> order_{0, 1, 2};  ///< axis numbers, longest first
  Vec3 axes_{0.0};                     ///< e [m], sorted
  Vec3 excess_{0.0};                   ///< r - 1 [-], sorted
  Vec3 scale_{0.0};                    ///< r_i / e_i [1/m], sorted
  Vec3 inverse_ratio_{0.0};            ///< 1 / r [-], as given
};

/// least (|p / radii| - 1), least the smallest semi-axis: the surface of the ellipsoid as a field
/// that costs a tenth of what the distance does and is smooth except at the center. Its slope is at
/// most 1 everywhere.
class EllipsoidFace final : public Field {
 public:
  EllipsoidFace(const Vec3& center, const Vec3& radii, double feature)
      : center_(center),
        radii_(radii),
        inverse_(1.0 / radii),
        least_(std::min({radii.x, radii.y, radii.z})),
        slope_(least_ * inverse_),
        feature_(feature) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const fields::Polar q = fields::polar((p - center_) * inverse_, Vec3(1.0, 0.0, 0.0));
    return {least_ * (q.length - 1.0), slope_ * q.direction};
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return least_ * (fields::length((p - center_) * inverse_) - 1.0);
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const fields::Polar q = fields::polar((p - center_) * inverse_, Vec3(1.0, 0.0, 0.0));
    FieldJet out{least_ * (q.length - 1.0), slope_ * q.direction, Mat3(0.0)};
    const Mat3 bend = fields::radialHessian(q.direction, q.length);
    for (int i = 0; i < 3; ++i) out.hessian[i] = slope_ * bend[i] * inverse_[i];
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override {
    return {center_ - radii_, center_ + radii_};
  }
  /// The value is a bound on the distance, but the slope on the surface is not 1.
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  Vec3 center_;
  Vec3 radii_;
  Vec3 inverse_;  ///< [1/m]
  double least_;  ///< [m]
  Vec3 slope_;    ///< least / radii [-]
  double feature_;
};

}  // namespace

FieldPtr ellipsoid(const Vec3& center, const Vec3& radii) {
  fields::checkPoint("ellipsoid", "center", center);
  fields::checkLengths("ellipsoid", "radii", radii);
  FieldPtr whole = std::make_shared<Ellipsoid>(center, radii);
  FieldPtr face = std::make_shared<EllipsoidFace>(center, radii, whole->featureSize());
  return withFaces(std::move(whole), {std::move(face)});
}

}  // namespace palpate
