#include <algorithm>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "fields/checks.h"
#include "fields/level_bounds.h"
#include "palpate/core/error.h"
#include "palpate/fields/csg.h"

namespace palpate {
namespace {

using Kind = FieldStructure::Kind;

class Scaled final : public Field, public fields::LevelBounded {
 public:
  Scaled(FieldPtr field, double factor) : field_(std::move(field)), factor_(factor) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    FieldSample out = field_->sample(p / factor_);
    out.value *= factor_;
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return field_->value(p / factor_) * factor_;
  }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    PointBatch shrunk;
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      shrunk.x[n] = points.x[n] / factor_;
      shrunk.y[n] = points.y[n] / factor_;
      shrunk.z[n] = points.z[n] / factor_;
    }
    field_->values(shrunk, out);
    for (double& value : out) value *= factor_;
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    FieldJet out = field_->jet(p / factor_);
    out.value *= factor_;
    out.hessian *= 1.0 / factor_;
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return grown(field_->bounds()); }
  [[nodiscard]] Metric metric() const noexcept override { return field_->metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return field_->lipschitz(); }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override {
    return grown(field_->lipschitzDomain());
  }
  [[nodiscard]] double featureSize() const noexcept override {
    return field_->featureSize() * factor_;
  }
  [[nodiscard]] Box3 boundsBelow(double level) const override {
    return grown(fields::boundsBelow(*field_, level / factor_));
  }

 private:
  [[nodiscard]] Box3 grown(const Box3& box) const noexcept {
    return {box.lo * factor_, box.hi * factor_};
  }

  FieldPtr field_;
  double factor_;
};

class Offset final : public Field, public fields::LevelBounded {
 public:
  Offset(FieldPtr field, double distance)
      : field_(std::move(field)),
        distance_(distance),
        bounds_(fields::boundsBelow(*field_, distance)) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    FieldSample out = field_->sample(p);
    out.value -= distance_;
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return field_->value(p) - distance_;
  }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    field_->values(points, out);
    for (double& value : out) value -= distance_;
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    FieldJet out = field_->jet(p);
    out.value -= distance_;
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override {
    return field_->metric() == Metric::kImplicit ? Metric::kImplicit : Metric::kBound;
  }
  [[nodiscard]] double lipschitz() const noexcept override { return field_->lipschitz(); }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return field_->lipschitzDomain(); }
  [[nodiscard]] double featureSize() const noexcept override {
    return std::min(field_->featureSize(), std::fabs(distance_));
  }
  [[nodiscard]] Box3 boundsBelow(double level) const override {
    return fields::boundsBelow(*field_, level + distance_);
  }

 private:
  FieldPtr field_;
  double distance_;
  Box3 bounds_;
};

/// Rebuilds a CSG tree with `change` applied to each leaf; a leaf that occurs twice is changed only
/// once.
class Rebuild {
 public:
  struct Change {
    std::function<FieldPtr(const FieldPtr&)> leaf;
    std::function<FieldPtr(const FieldPtr&)> complemented;  ///< for a complement's operand
    double translation_factor = 1.0;
    bool opens_faces = true;    ///< a solid with faces may be rebuilt by its faces
    bool keeps_levels = false;  ///< ... but only where the values of the faces are distances
  };

  static FieldPtr of(const FieldPtr& field, const Change& change) {
    Rebuild rebuild(change);
    return rebuild.visit(field);
  }

 private:
  explicit Rebuild(const Change& change) : change_(change) {}

  FieldPtr visit(const FieldPtr& field) {
    const auto known = done_.find(field.get());
    if (known != done_.end()) return known->second;
    FieldPtr made = make(field);
    done_.emplace(field.get(), made);
    return made;
  }

  FieldPtr make(const FieldPtr& field) {
    const FieldStructure structure = field->structure();
    std::vector<FieldPtr> operands;
    const auto visit_all = [&] {
      for (const FieldPtr& operand : structure.operands) operands.push_back(visit(operand));
      return std::move(operands);
    };
    switch (structure.kind) {
      case Kind::kUnion:
        return unite(visit_all());
      case Kind::kIntersection:
        return intersect(visit_all());
      case Kind::kComplement:
        return complement(change_.complemented(structure.operands.front()));
      case Kind::kTransform:
        return place(
            visit(structure.operands.front()),
            {structure.pose.rotation, structure.pose.translation * change_.translation_factor});
      case Kind::kFaces:
        if (!change_.opens_faces || (change_.keeps_levels && !areExact(structure.operands))) break;
        return withFaces(change_.leaf(field), visit_all());
      case Kind::kLeaf:
        break;
    }
    return change_.leaf(field);
  }

  static bool areExact(std::span<const FieldPtr> faces) {
    return std::all_of(faces.begin(), faces.end(),
                       [](const FieldPtr& face) { return face->metric() == Metric::kExact; });
  }

  const Change& change_;
  std::unordered_map<const Field*, FieldPtr> done_;
};

}  // namespace

FieldPtr scale(FieldPtr field, double factor) {
  FieldPtr operand = fields::checkedOperand("scale", std::move(field));
  fields::checkRange("scale", "factor", factor, 1e-6, 1e6);
  if (factor == 1.0) return operand;
  return Rebuild::of(
      operand, {.leaf = [=](const FieldPtr& f) { return std::make_shared<Scaled>(f, factor); },
                .complemented = [=](const FieldPtr& f) { return scale(f, factor); },
                .translation_factor = factor});
}

FieldPtr offset(FieldPtr field, double distance) {
  FieldPtr operand = fields::checkedOperand("offset", std::move(field));
  fields::checkRange("offset", "distance", distance, -fields::kLargestLength,
                     fields::kLargestLength);
  if (std::fabs(distance) < fields::kSmallestLength) return operand;
  fields::checkBand("offset", *operand, std::fabs(distance));
  // A box that shrinks stays a box; one that grows gets rounded edges and is smooth.
  return Rebuild::of(
      operand, {.leaf = [=](const FieldPtr& f) { return std::make_shared<Offset>(f, distance); },
                .complemented = [=](const FieldPtr& f) { return offset(f, -distance); },
                .opens_faces = distance < 0.0,
                .keeps_levels = true});
}

FieldPtr shell(FieldPtr field, double thickness) {
  const FieldPtr operand = fields::checkedOperand("shell", std::move(field));
  fields::checkLength("shell", "thickness", thickness);
  return subtract({operand, offset(operand, -thickness)});
}

}  // namespace palpate
