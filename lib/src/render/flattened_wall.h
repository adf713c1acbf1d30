#pragma once
/// A wall that is blended towards its tangent plane at the proxy.

#include "palpate/fields/field.h"

namespace palpate {

/// (1 - share) S(p) + share (S(x) + grad S(x) . (p - x)), x the proxy. A ball becomes a body of
/// revolution about the normal at the proxy. Its section is a conic with the ball's center as
/// focus: an ellipse, or with a share above one half a hyperbola, which no path leads around. All
/// members are real-time safe.
class FlattenedWall final : public Field {
 public:
  FlattenedWall() = default;
  /// `jet` is that of `wall` at `proxy` [m]; `by_press` [1/m] is the gradient of the share by the
  /// press vector.
  FlattenedWall(const Field& wall, const FieldJet& jet, const Vec3& proxy, double share,
                const Vec3& by_press) noexcept
      : wall_(&wall), jet_(jet), proxy_(proxy), share_(share), by_press_(by_press) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldJet all = jet(p);
    return {all.value, all.gradient, all.in_band};
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    FieldJet out{plane(p), jet_.gradient, Mat3(0.0), true};
    if (share_ >= 1.0) return out;
    const FieldJet bent = wall_->jet(p);
    out.value = glm::mix(bent.value, out.value, share_);
    out.gradient = glm::mix(bent.gradient, out.gradient, share_);
    out.hessian = (1.0 - share_) * bent.hessian;
    out.in_band = bent.in_band;
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return wall_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kBound; }
  [[nodiscard]] double lipschitz() const noexcept override { return wall_->lipschitz(); }
  [[nodiscard]] double featureSize() const noexcept override { return wall_->featureSize(); }

  /// Derivative of its value at `p` [m] by the proxy's place along the wall.
  [[nodiscard]] Vec3 byProxy(const Vec3& p) const noexcept {
    return share_ * (jet_.hessian * (p - proxy_));
  }
  /// Derivative of its value at `p` [m] by the press vector.
  [[nodiscard]] Vec3 byPress(const Vec3& p) const noexcept {
    if (by_press_ == Vec3(0.0)) return by_press_;
    return (plane(p) - wall_->value(p)) * by_press_;
  }

 private:
  [[nodiscard]] double plane(const Vec3& p) const noexcept {
    return jet_.value + glm::dot(jet_.gradient, p - proxy_);
  }

  const Field* wall_ = nullptr;
  FieldJet jet_{};
  Vec3 proxy_{0.0, 0.0, 0.0};  ///< [m]
  double share_ = 0.0;
  Vec3 by_press_{0.0, 0.0, 0.0};  ///< [1/m]
};

}  // namespace palpate
