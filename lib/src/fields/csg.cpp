#include "palpate/fields/csg.h"

#include <algorithm>
#include <array>
#include <utility>

#include "fields/checks.h"
#include "fields/operand_tree.h"

namespace palpate {
namespace {

using Kind = FieldStructure::Kind;

/// Properties that are computed alike for the min and the max of fields.
struct Shared {
  Metric metric = Metric::kBound;
  double lipschitz = 0.0;
  Box3 lipschitz_domain = Box3::everything();
  double feature = kInfinity;
};

Shared sharedBy(std::span<const FieldPtr> operands) {
  Shared out;
  for (const FieldPtr& operand : operands) {
    if (operand->metric() == Metric::kImplicit) out.metric = Metric::kImplicit;
    out.lipschitz = std::max(out.lipschitz, operand->lipschitz());
    out.lipschitz_domain = out.lipschitz_domain.intersectedWith(operand->lipschitzDomain());
    out.feature = std::min(out.feature, operand->featureSize());
  }
  return out;
}

/// The intersection of disjoint boxes has negative size; a plain empty box can safely be united
/// with others.
Box3 tidy(const Box3& box) { return box.isEmpty() ? Box3{} : box; }

/// Box around S >= 0, as small as the structure of the field tells.
Box3 boundsOfComplement(const Field& field) {
  const FieldStructure structure = field.structure();
  switch (structure.kind) {
    case Kind::kUnion: {
      Box3 box = Box3::everything();
      for (const FieldPtr& operand : structure.operands) {
        box = box.intersectedWith(boundsOfComplement(*operand));
      }
      return tidy(box);
    }
    case Kind::kFaces:
    case Kind::kIntersection: {
      Box3 box;
      for (const FieldPtr& operand : structure.operands) {
        box = box.unitedWith(boundsOfComplement(*operand));
      }
      return box;
    }
    case Kind::kComplement:
      return structure.operands.front()->bounds();
    case Kind::kTransform:
      return structure.pose.apply(boundsOfComplement(*structure.operands.front()));
    case Kind::kLeaf:
      break;
  }
  return Box3::everything();
}

/// The min (union) or max (intersection) of the operands; if several are equal, the first one
/// decides.
template <Kind kKind>
class Extremum final : public Field {
 public:
  explicit Extremum(std::vector<FieldPtr> operands)
      : operands_(std::move(operands)),
        shared_(sharedBy(operands_)),
        bounds_(boundsOf(operands_)),
        tree_(operands_, kKind == Kind::kUnion) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    if (isSearched(p)) return operands_[tree_.find(operands_, p).index]->sample(p);
    FieldSample best = operands_.front()->sample(p);
    for (std::size_t i = 1; i < operands_.size(); ++i) {
      const FieldSample next = operands_[i]->sample(p);
      if (wins(next.value, best.value)) best = next;
    }
    return best;
  }

  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return isSearched(p) ? tree_.find(operands_, p).value : askAll(p).value;
  }

  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    if (tree_.isUseful()) return Field::values(points, out);
    operands_.front()->values(points, out);
    ValueBatch next;
    for (std::size_t i = 1; i < operands_.size(); ++i) {
      operands_[i]->values(points, next);
      for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
        out[n] = wins(next[n], out[n]) ? next[n] : out[n];
      }
    }
  }

  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    return operands_[(isSearched(p) ? tree_.find(operands_, p) : askAll(p)).index]->jet(p);
  }

  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return shared_.metric; }
  [[nodiscard]] double lipschitz() const noexcept override { return shared_.lipschitz; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return shared_.lipschitz_domain; }
  [[nodiscard]] double featureSize() const noexcept override { return shared_.feature; }
  [[nodiscard]] FieldStructure structure() const noexcept override {
    return {kKind, operands_, {}};
  }

 private:
  /// The boxes do not help at points so far away that squares of their distances overflow.
  [[nodiscard]] bool isSearched(const Vec3& p) const noexcept {
    constexpr double kFarthest = 1e100;
    return tree_.isUseful() && std::fabs(p.x) < kFarthest && std::fabs(p.y) < kFarthest &&
           std::fabs(p.z) < kFarthest;
  }
  [[nodiscard]] fields::OperandTree::Found askAll(const Vec3& p) const noexcept {
    fields::OperandTree::Found best{operands_.front()->value(p), 0};
    for (std::size_t i = 1; i < operands_.size(); ++i) {
      const double next = operands_[i]->value(p);
      if (wins(next, best.value)) best = {next, i};
    }
    return best;
  }
  static bool wins(double next, double best) noexcept {
    return kKind == Kind::kUnion ? next < best : next > best;
  }
  static Box3 boundsOf(const std::vector<FieldPtr>& operands) {
    Box3 box = kKind == Kind::kUnion ? Box3{} : Box3::everything();
    for (const FieldPtr& operand : operands) {
      const Box3 other = operand->bounds();
      box = kKind == Kind::kUnion ? box.unitedWith(other) : box.intersectedWith(other);
    }
    return tidy(box);
  }

  std::vector<FieldPtr> operands_;
  Shared shared_;
  Box3 bounds_;
  fields::OperandTree tree_;
};

class Complement final : public Field {
 public:
  explicit Complement(FieldPtr operand)
      : operands_{std::move(operand)}, bounds_(boundsOfComplement(*operands_.front())) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    FieldSample out = operand().sample(p);
    out.value = -out.value;
    out.gradient = -out.gradient;
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return -operand().value(p); }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    operand().values(points, out);
    for (double& value : out) value = -value;
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    FieldJet out = operand().jet(p);
    out.value = -out.value;
    out.gradient = -out.gradient;
    out.hessian = -out.hessian;
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return operand().metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return operand().lipschitz(); }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override {
    return operand().lipschitzDomain();
  }
  [[nodiscard]] double featureSize() const noexcept override { return operand().featureSize(); }
  [[nodiscard]] FieldStructure structure() const noexcept override {
    return {Kind::kComplement, operands_, {}};
  }

 private:
  [[nodiscard]] const Field& operand() const noexcept { return *operands_.front(); }

  std::array<FieldPtr, 1> operands_;
  Box3 bounds_;
};

}  // namespace

FieldPtr unite(std::vector<FieldPtr> operands) {
  fields::checkOperands("union", operands, 1);
  if (operands.size() == 1) return operands.front();
  return std::make_shared<Extremum<Kind::kUnion>>(std::move(operands));
}

FieldPtr intersect(std::vector<FieldPtr> operands) {
  fields::checkOperands("intersection", operands, 1);
  if (operands.size() == 1) return operands.front();
  return std::make_shared<Extremum<Kind::kIntersection>>(std::move(operands));
}

FieldPtr subtract(std::vector<FieldPtr> operands) {
  fields::checkOperands("difference", operands, 1);
  for (std::size_t i = 1; i < operands.size(); ++i) operands[i] = complement(operands[i]);
  return intersect(std::move(operands));
}

FieldPtr complement(FieldPtr operand) {
  return std::make_shared<Complement>(fields::checkedOperand("complement", std::move(operand)));
}

}  // namespace palpate
