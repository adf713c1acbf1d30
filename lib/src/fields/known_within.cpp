#include <glm/common.hpp>
#include <utility>

#include "fields/checks.h"
#include "palpate/core/error.h"
#include "palpate/fields/csg.h"

namespace palpate {
namespace {

class KnownWithin final : public Field {
 public:
  KnownWithin(FieldPtr field, const Box3& box)
      : field_(std::move(field)), box_(box), bounds_(field_->bounds()) {
    // Where the box cuts the solid, the solid continues without end.
    for (int axis = 0; axis < 3 && !bounds_.isEmpty(); ++axis) {
      if (bounds_.lo[axis] < box_.lo[axis]) bounds_.lo[axis] = -kInfinity;
      if (bounds_.hi[axis] > box_.hi[axis]) bounds_.hi[axis] = kInfinity;
    }
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    if (box_.contains(p)) return field_->sample(p);
    FieldSample out = field_->sample(nearest(p));
    out.gradient *= free(p);
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return field_->value(box_.contains(p) ? p : nearest(p));
  }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    PointBatch moved;
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      const Vec3 q = box_.contains(points[n]) ? points[n] : nearest(points[n]);
      moved.x[n] = q.x;
      moved.y[n] = q.y;
      moved.z[n] = q.z;
    }
    field_->values(moved, out);
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    if (box_.contains(p)) return field_->jet(p);
    FieldJet out = field_->jet(nearest(p));
    const Vec3 axes = free(p);
    out.gradient *= axes;
    for (int c = 0; c < 3; ++c) out.hessian[c] *= axes[c] * axes;
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return field_->lipschitz(); }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override {
    const Box3 domain = field_->lipschitzDomain();
    const bool holds = domain.contains(box_.lo) && domain.contains(box_.hi);
    return holds ? Box3::everything() : domain.intersectedWith(box_);
  }
  [[nodiscard]] double featureSize() const noexcept override { return field_->featureSize(); }

  [[nodiscard]] const Field& field() const noexcept { return *field_; }

 private:
  /// The nearest point in the box; a point that is not finite stays so.
  [[nodiscard]] Vec3 nearest(const Vec3& p) const noexcept {
    return isFinite(p) ? glm::clamp(p, box_.lo, box_.hi) : p;
  }
  /// 1 along the axes on which `p` is within the box's range, 0 along the others.
  [[nodiscard]] Vec3 free(const Vec3& p) const noexcept {
    Vec3 out(1.0);
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] < box_.lo[axis] || p[axis] > box_.hi[axis]) out[axis] = 0.0;
    }
    return out;
  }

  FieldPtr field_;
  Box3 box_;
  Box3 bounds_;
};

}  // namespace

FieldPtr knownWithin(FieldPtr field, const Box3& box) {
  field = fields::checkedOperand("knownWithin", std::move(field));
  if (box.isEmpty()) {
    throw inputError("field.empty_box", "the box within which a field is known is empty",
                     "give a box whose lower corner lies below the upper one");
  }
  return std::make_shared<KnownWithin>(std::move(field), box);
}

const Field& knownField(const Field& field) noexcept {
  const auto* known = dynamic_cast<const KnownWithin*>(&field);
  return known != nullptr ? known->field() : field;
}

}  // namespace palpate
