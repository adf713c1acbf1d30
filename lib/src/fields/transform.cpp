#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fields/checks.h"
#include "palpate/core/error.h"
#include "palpate/fields/csg.h"

namespace palpate {
namespace {

class Placed final : public Field {
 public:
  Placed(FieldPtr field, const Pose& pose)
      : operands_{std::move(field)}, pose_(pose), back_(glm::transpose(pose.rotation)) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    FieldSample out = operand().sample(toOperand(p));
    out.gradient = pose_.rotate(out.gradient);
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return operand().value(toOperand(p));
  }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    PointBatch moved;
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      const Vec3 p = toOperand(points[n]);
      moved.x[n] = p.x;
      moved.y[n] = p.y;
      moved.z[n] = p.z;
    }
    operand().values(moved, out);
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    FieldJet out = operand().jet(toOperand(p));
    out.gradient = pose_.rotate(out.gradient);
    const Mat3 turned = pose_.rotation * out.hessian * back_;
    out.hessian = 0.5 * (turned + glm::transpose(turned));
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return pose_.apply(operand().bounds()); }
  [[nodiscard]] Metric metric() const noexcept override { return operand().metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return operand().lipschitz(); }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override {
    return boxWithin(operand().lipschitzDomain());
  }
  [[nodiscard]] double featureSize() const noexcept override { return operand().featureSize(); }
  [[nodiscard]] bool isFlat() const noexcept override { return operand().isFlat(); }
  [[nodiscard]] FieldStructure structure() const noexcept override {
    return {FieldStructure::Kind::kTransform, operands_, pose_};
  }

 private:
  [[nodiscard]] const Field& operand() const noexcept { return *operands_.front(); }
  [[nodiscard]] Vec3 toOperand(const Vec3& p) const noexcept {
    return back_ * (p - pose_.translation);
  }
  /// A box in this frame that lies inside the moved box of the operand, about its moved center: its
  /// corners, in the operand's frame, must not leave the operand's box.
  [[nodiscard]] Box3 boxWithin(const Box3& domain) const noexcept;

  std::array<FieldPtr, 1> operands_;
  Pose pose_;
  Mat3 back_;
};

bool isQuarterTurn(const Mat3& m) {
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      if (m[column][row] != 0.0 && std::fabs(m[column][row]) != 1.0) return false;
    }
  }
  return true;
}

Box3 Placed::boxWithin(const Box3& domain) const noexcept {
  const Box3 everything = Box3::everything();
  if (domain.lo == everything.lo && domain.hi == everything.hi) return domain;
  if (isQuarterTurn(pose_.rotation)) return pose_.apply(domain);
  if (!domain.isBounded()) return Box3{};  // half-infinite and rotated: no box fits inside
  // Shrink the bounding box of the moved box until it fits into the moved box.
  const Vec3 half = 0.5 * pose_.apply(domain).size();
  const Vec3 room = 0.5 * domain.size();
  double share = 1.0;
  for (int row = 0; row < 3; ++row) {
    double reach = 0.0;
    for (int column = 0; column < 3; ++column) {
      reach += std::fabs(back_[column][row]) * half[column];
    }
    if (reach > 0.0) share = std::min(share, room[row] / reach);
  }
  const Vec3 center = pose_.apply(domain.center());
  return {center - share * half, center + share * half};
}

/// The rotation nearest to `m`, which is itself a rotation to about 1e-9: one Newton step of the
/// polar decomposition squares the error.
Mat3 nearestRotation(const Mat3& m) { return m * (0.5 * (Mat3(3.0) - glm::transpose(m) * m)); }

bool isRotation(const Mat3& m) {
  const Mat3 defect = glm::transpose(m) * m - Mat3(1.0);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      if (!(std::fabs(defect[column][row]) <= 1e-9)) return false;
    }
  }
  return glm::determinant(m) > 0.0;
}

}  // namespace

FieldPtr place(FieldPtr field, const Pose& pose) {
  FieldPtr operand = fields::checkedOperand("transform", std::move(field));
  fields::checkPoint("transform", "translation", pose.translation);
  if (!isRotation(pose.rotation)) {
    throw inputError("field.not_rigid",
                     "transform: the matrix is not a rotation; its columns must be orthonormal "
                     "(to 1e-9), its determinant +1",
                     "to scale a shape, change its own sizes");
  }
  return std::make_shared<Placed>(std::move(operand),
                                  Pose{nearestRotation(pose.rotation), pose.translation});
}

}  // namespace palpate
