#include "palpate/fields/blend.h"

#include <algorithm>
#include <utility>

#include "fields/checks.h"
#include "fields/level_bounds.h"

namespace palpate {
namespace {

/// Which sides are turned about, so that one smooth minimum serves all three.
struct Sides {
  double first = 1.0;
  double second = 1.0;
  double result = 1.0;
};

/// result * smin(first * a, second * b) with the cubic smooth minimum
///   smin(A, B) = min(A, B) - h^3 k / 6,  h = max(0, 1 - |A - B| / k),
/// whose partial derivatives are never negative and add up to 1.
class Blend final : public Field, public fields::LevelBounded {
 public:
  Blend(FieldPtr a, FieldPtr b, double radius, const Sides& signs)
      : a_(std::move(a)), b_(std::move(b)), radius_(radius), signs_(signs) {
    if (signs_.first > 0.0) {
      bounds_ = below(0.0);
    } else {
      bounds_ = a_->bounds();  // intersection: inside a, and inside b or outside it
      if (signs_.second < 0.0) bounds_ = bounds_.intersectedWith(b_->bounds());
      if (bounds_.isEmpty()) bounds_ = Box3{};
    }
    const bool is_bound = a_->metric() != Metric::kImplicit && b_->metric() != Metric::kImplicit;
    metric_ = is_bound ? Metric::kBound : Metric::kImplicit;
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample a = a_->sample(p);
    const FieldSample b = b_->sample(p);
    const Mix mix = mixOf(a.value, b.value);
    FieldSample out{mix.value, Vec3(0.0), isInBand(mix, a.in_band, b.in_band)};
    if (out.in_band) out.gradient = a.gradient * mix.of_a + b.gradient * mix.of_b;
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return mixOf(a_->value(p), b_->value(p)).value;
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const FieldJet a = a_->jet(p);
    const FieldJet b = b_->jet(p);
    const Mix mix = mixOf(a.value, b.value);
    FieldJet out{mix.value, Vec3(0.0), Mat3(0.0), isInBand(mix, a.in_band, b.in_band)};
    if (!out.in_band) return out;
    out.gradient = a.gradient * mix.of_a + b.gradient * mix.of_b;
    const Vec3 apart = a.gradient * signs_.first - b.gradient * signs_.second;
    out.hessian = a.hessian * mix.of_a + b.hessian * mix.of_b -
                  outer(apart, apart) * (signs_.result * mix.bend);
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return metric_; }
  [[nodiscard]] double lipschitz() const noexcept override {
    return std::max(a_->lipschitz(), b_->lipschitz());
  }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override {
    return a_->lipschitzDomain().intersectedWith(b_->lipschitzDomain());
  }
  [[nodiscard]] double featureSize() const noexcept override {
    return std::min({a_->featureSize(), b_->featureSize(), radius_});
  }
  [[nodiscard]] Box3 boundsBelow(double level) const override {
    if (signs_.first > 0.0) return below(level);
    Box3 box = fields::boundsBelow(*a_, level);
    if (signs_.second < 0.0) box = box.intersectedWith(fields::boundsBelow(*b_, level));
    return box.isEmpty() ? Box3{} : box;
  }

 private:
  struct Mix {
    double value = 0.0;
    double of_a = 0.0;  ///< derivative by the value of a
    double of_b = 0.0;
    double bend = 0.0;  ///< [1/m] second derivative by their difference
  };

  [[nodiscard]] Mix mixOf(double a, double b) const noexcept {
    const double first = signs_.first * a;
    const double second = signs_.second * b;
    const double gap = std::fabs(first - second);
    const double h = gap < radius_ ? 1.0 - gap / radius_ : 0.0;
    const double least = second < first ? second : first;
    const double lesser = 0.5 * h * h;  // the share of the larger one
    const double share_of_second = second < first ? 1.0 - lesser : lesser;
    return {signs_.result * (least - h * h * h * radius_ / 6.0),
            signs_.result * signs_.first * (1.0 - share_of_second),
            signs_.result * signs_.second * share_of_second, h / radius_};
  }

  /// What has no share may be out of its band.
  static bool isInBand(const Mix& mix, bool a, bool b) noexcept {
    return (a || mix.of_a == 0.0) && (b || mix.of_b == 0.0);
  }

  /// The smooth union is at most radius / 6 below the smaller operand.
  [[nodiscard]] Box3 below(double level) const {
    const double most = level + radius_ / 6.0;
    return fields::boundsBelow(*a_, most).unitedWith(fields::boundsBelow(*b_, most));
  }

  FieldPtr a_;
  FieldPtr b_;
  double radius_;
  Sides signs_;
  Box3 bounds_;
  Metric metric_ = Metric::kBound;
};

FieldPtr fold(const char* shape, std::vector<FieldPtr> operands, double radius,
              const Sides& signs) {
  fields::checkOperands(shape, operands, 1);
  fields::checkLength(shape, "radius", radius);
  FieldPtr out = operands.front();
  for (std::size_t i = 1; i < operands.size(); ++i) {
    out = std::make_shared<Blend>(std::move(out), std::move(operands[i]), radius, signs);
  }
  return out;
}

}  // namespace

FieldPtr smoothUnite(std::vector<FieldPtr> operands, double radius) {
  return fold("smooth_union", std::move(operands), radius, {1.0, 1.0, 1.0});
}

FieldPtr smoothIntersect(std::vector<FieldPtr> operands, double radius) {
  return fold("smooth_intersection", std::move(operands), radius, {-1.0, -1.0, -1.0});
}

FieldPtr smoothSubtract(std::vector<FieldPtr> operands, double radius) {
  return fold("smooth_difference", std::move(operands), radius, {-1.0, 1.0, -1.0});
}

}  // namespace palpate
