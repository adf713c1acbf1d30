#include "label_share.h"

#include <algorithm>
#include <utility>

namespace palpate {
namespace {

class LabelShare final : public Field {
 public:
  LabelShare(FieldPtr own, std::vector<FieldPtr> others)
      : own_(std::move(own)), others_(std::move(others)) {
    lipschitz_ = own_->lipschitz();
    feature_ = own_->featureSize();
    domain_ = own_->lipschitzDomain();
    for (const FieldPtr& other : others_) {
      lipschitz_ = std::max(lipschitz_, 0.5 * (own_->lipschitz() + other->lipschitz()));
      feature_ = std::min(feature_, other->featureSize());
      domain_ = domain_.intersectedWith(other->lipschitzDomain());
    }
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const FieldSample own = own_->sample(p);
    FieldSample out = own;
    for (const FieldPtr& other : others_) {
      // Away from the other label its field is positive, and half the difference is below own.value.
      if (other->value(p) >= -own.value) continue;
      const FieldSample theirs = other->sample(p);
      const double half = 0.5 * (own.value - theirs.value);
      if (half > out.value) {
        out.value = half;
        out.in_band = own.in_band && theirs.in_band;
        out.gradient = out.in_band ? 0.5 * (own.gradient - theirs.gradient) : Vec3(0.0);
      }
    }
    return out;
  }

  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    const double own = own_->value(p);
    double out = own;
    for (const FieldPtr& other : others_) out = std::max(out, 0.5 * (own - other->value(p)));
    return out;
  }

  [[nodiscard]] Box3 bounds() const noexcept override { return own_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return domain_; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  FieldPtr own_;
  std::vector<FieldPtr> others_;
  double lipschitz_ = 1.0;
  double feature_ = 1.0;
  Box3 domain_;
};

}  // namespace

std::vector<FieldPtr> shareLabels(const std::vector<FieldPtr>& fields) {
  if (fields.size() < 2) return fields;
  std::vector<FieldPtr> out;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    // Labels whose boxes stay apart cannot meet.
    std::vector<FieldPtr> others;
    for (std::size_t j = 0; j < fields.size(); ++j) {
      const double reach = fields[i]->featureSize() + fields[j]->featureSize();
      if (j != i && !fields[i]
                         ->bounds()
                         .grownBy(reach)
                         .intersectedWith(fields[j]->bounds().grownBy(reach))
                         .isEmpty()) {
        others.push_back(fields[j]);
      }
    }
    out.push_back(others.empty() ? fields[i]
                                 : std::make_shared<LabelShare>(fields[i], std::move(others)));
  }
  return out;
}

}  // namespace palpate
