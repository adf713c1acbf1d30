#include <algorithm>
#include <numbers>

#include "fields/checks.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"

namespace palpate {
namespace {

/// On the surface the gradient of the gyroid function by (X, Y, Z) has a length between sqrt(2) and
/// sqrt(3), which is the largest anywhere.
constexpr double kSteepest = 1.7320508075688774;

/// side * (g / (k sqrt(3))) - shift, g the gyroid function, k = 2 pi / period.
class Gyroid final : public Field {
 public:
  Gyroid(const Vec3& center, double period, double side, double shift, double feature)
      : center_(center),
        period_(period),
        wave_(2.0 * std::numbers::pi / period),
        side_(side),
        shift_(shift),
        feature_(feature) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const Waves w = wavesAt(p);
    return {valueOf(w), gradientOf(w)};
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const Waves w = wavesAt(p);
    Mat3 h(0.0);
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      const int last = (i + 2) % 3;
      h[i][i] = -w.sin[i] * w.cos[next] - w.sin[last] * w.cos[i];
      h[i][next] = h[next][i] = -w.cos[i] * w.sin[next];
    }
    return {valueOf(w), gradientOf(w), h * (side_ * wave_ / kSteepest)};
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return Box3::everything(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  struct Waves {
    Vec3 sin{0.0}, cos{0.0};
  };

  [[nodiscard]] Waves wavesAt(const Vec3& p) const noexcept {
    Waves w;
    for (int i = 0; i < 3; ++i) {
      double d = p[i] - center_[i];
      // At this distance the phase is only rounding; it must still not overflow.
      if (!(std::fabs(d) < 1e12 * period_)) [[unlikely]]
        d = std::remainder(d, period_);
      w.sin[i] = std::sin(wave_ * d);
      w.cos[i] = std::cos(wave_ * d);
    }
    return w;
  }
  [[nodiscard]] double valueOf(const Waves& w) const noexcept {
    const double g = w.sin.x * w.cos.y + w.sin.y * w.cos.z + w.sin.z * w.cos.x;
    return side_ * g / (wave_ * kSteepest) - shift_;
  }
  [[nodiscard]] Vec3 gradientOf(const Waves& w) const noexcept {
    return Vec3(w.cos.x * w.cos.y - w.sin.z * w.sin.x, w.cos.y * w.cos.z - w.sin.x * w.sin.y,
                w.cos.z * w.cos.x - w.sin.y * w.sin.z) *
           (side_ / kSteepest);
  }

  Vec3 center_;
  double period_;
  double wave_;  ///< [1/m]
  double side_;
  double shift_;  ///< [m]
  double feature_;
};

}  // namespace

FieldPtr gyroid(const Vec3& center, double period) {
  fields::checkPoint("gyroid", "center", center);
  fields::checkLength("gyroid", "period", period);
  return std::make_shared<Gyroid>(center, period, 1.0, 0.0, period / 8.0);
}

FieldPtr gyroidWall(const Vec3& center, double period, double thickness) {
  fields::checkPoint("gyroid", "center", center);
  fields::checkLength("gyroid", "period", period);
  fields::checkRange("gyroid", "thickness", thickness, fields::kSmallestLength, 0.2 * period);
  // On the surface the slope is 0.816 to 1 times the steepest one: take the middle.
  const double shift = 0.5 * thickness * 0.9;
  const double feature = std::min(period / 8.0, thickness);
  return intersect({std::make_shared<Gyroid>(center, period, 1.0, shift, feature),
                    std::make_shared<Gyroid>(center, period, -1.0, shift, feature)});
}

}  // namespace palpate
