#include <algorithm>
#include <utility>

#include "fields/checks.h"
#include "fields/level_bounds.h"
#include "palpate/fields/csg.h"

namespace palpate {
namespace {

/// The signs that turn one smooth minimum into union, intersection and difference.
struct Sides {
  double first = 1.0;
  double second = 1.0;
  double result = 1.0;
};

/// Starting with the first operand, each further one `next` is combined with the result `so far`:
/// result * smin(first * so far, second * next), with the cubic smooth minimum
///   smin(A, B) = min(A, B) - h^3 k / 6,  h = max(0, 1 - |A - B| / k),
/// whose partial derivatives are never negative and add up to 1.
class Blend final : public Field, public fields::LevelBounded {
 public:
  Blend(std::vector<FieldPtr> operands, double radius, const Sides& signs)
      : operands_(std::move(operands)), radius_(radius), signs_(signs) {
    bounds_ = below(0.0);
    feature_ = radius_;
    for (const FieldPtr& operand : operands_) {
      if (operand->metric() == Metric::kImplicit) metric_ = Metric::kImplicit;
      lipschitz_ = std::max(lipschitz_, operand->lipschitz());
      lipschitz_domain_ = lipschitz_domain_.intersectedWith(operand->lipschitzDomain());
      feature_ = std::min(feature_, operand->featureSize());
    }
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    FieldSample out = operands_.front()->sample(p);
    for (std::size_t i = 1; i < operands_.size(); ++i) {
      const FieldSample next = operands_[i]->sample(p);
      const Mix mix = mixOf(out.value, next.value);
      out.in_band = isInBand(mix, out.in_band, next.in_band);
      out.value = mix.value;
      out.gradient = out.in_band ? out.gradient * mix.of_a + next.gradient * mix.of_b : Vec3(0.0);
    }
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    double out = operands_.front()->value(p);
    for (std::size_t i = 1; i < operands_.size(); ++i) {
      out = mixOf(out, operands_[i]->value(p)).value;
    }
    return out;
  }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    operands_.front()->values(points, out);
    ValueBatch next;
    for (std::size_t i = 1; i < operands_.size(); ++i) {
      operands_[i]->values(points, next);
      for (std::size_t n = 0; n < PointBatch::kCount; ++n) out[n] = mixOf(out[n], next[n]).value;
    }
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    FieldJet out = operands_.front()->jet(p);
    for (std::size_t i = 1; i < operands_.size(); ++i) {
      const FieldJet next = operands_[i]->jet(p);
      const Mix mix = mixOf(out.value, next.value);
      out.in_band = isInBand(mix, out.in_band, next.in_band);
      out.value = mix.value;
      if (!out.in_band) {
        out.gradient = Vec3(0.0);
        out.hessian = Mat3(0.0);
        continue;
      }
      const Vec3 apart = out.gradient * signs_.first - next.gradient * signs_.second;
      out.hessian = out.hessian * mix.of_a + next.hessian * mix.of_b -
                    outer(apart, apart) * (signs_.result * mix.bend);
      out.gradient = out.gradient * mix.of_a + next.gradient * mix.of_b;
    }
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return metric_; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return lipschitz_domain_; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }
  [[nodiscard]] Box3 boundsBelow(double level) const override { return below(level); }

 private:
  struct Mix {
    double value = 0.0;
    double of_a = 0.0;  ///< derivative by the value of a
    double of_b = 0.0;
    double bend = 0.0;  ///< [1/m] second derivative by the difference of a and b
  };

  [[nodiscard]] Mix mixOf(double a, double b) const noexcept {
    const double first = signs_.first * a;
    const double second = signs_.second * b;
    const double gap = std::fabs(first - second);
    const double h = gap < radius_ ? 1.0 - gap / radius_ : 0.0;
    const double least = second < first ? second : first;
    const double lesser = 0.5 * h * h;  // the weight of the larger one
    const double share_of_second = second < first ? 1.0 - lesser : lesser;
    return {signs_.result * (least - h * h * h * radius_ / 6.0),
            signs_.result * signs_.first * (1.0 - share_of_second),
            signs_.result * signs_.second * share_of_second, h / radius_};
  }

  /// An operand with weight zero may be outside its band.
  static bool isInBand(const Mix& mix, bool a, bool b) noexcept {
    return (a || mix.of_a == 0.0) && (b || mix.of_b == 0.0);
  }

  /// Each step of a smooth union is at most radius / 6 below the smaller operand; intersections and
  /// differences are never below the plain ones.
  [[nodiscard]] Box3 below(double level) const {
    if (signs_.first > 0.0) {
      Box3 box;
      double most = level;
      for (std::size_t i = operands_.size(); i-- > 0;) {
        if (i > 0) most += radius_ / 6.0;
        box = box.unitedWith(fields::boundsBelow(*operands_[i], most));
      }
      return box;
    }
    Box3 box = fields::boundsBelow(*operands_.front(), level);
    if (signs_.second < 0.0) {
      for (const FieldPtr& operand : operands_) {
        box = box.intersectedWith(fields::boundsBelow(*operand, level));
      }
    }
    return box.isEmpty() ? Box3{} : box;
  }

  std::vector<FieldPtr> operands_;
  double radius_;
  Sides signs_;
  Box3 bounds_;
  Metric metric_ = Metric::kBound;
  double lipschitz_ = 0.0;
  Box3 lipschitz_domain_ = Box3::everything();
  double feature_ = 0.0;
};

FieldPtr blended(const char* shape, std::vector<FieldPtr> operands, double radius,
                 const Sides& signs) {
  fields::checkOperands(shape, operands, 1);
  fields::checkLength(shape, "radius", radius);
  if (operands.size() == 1) return operands.front();
  for (const FieldPtr& operand : operands) fields::checkBand(shape, *operand, radius);
  return std::make_shared<Blend>(std::move(operands), radius, signs);
}

}  // namespace

FieldPtr smoothUnite(std::vector<FieldPtr> operands, double radius) {
  return blended("smooth_union", std::move(operands), radius, {1.0, 1.0, 1.0});
}

FieldPtr smoothIntersect(std::vector<FieldPtr> operands, double radius) {
  return blended("smooth_intersection", std::move(operands), radius, {-1.0, -1.0, -1.0});
}

FieldPtr smoothSubtract(std::vector<FieldPtr> operands, double radius) {
  return blended("smooth_difference", std::move(operands), radius, {-1.0, 1.0, -1.0});
}

}  // namespace palpate
