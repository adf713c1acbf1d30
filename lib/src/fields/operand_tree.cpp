#include "fields/operand_tree.h"

#include <algorithm>

namespace palpate::fields {
namespace {

using Kind = FieldStructure::Kind;

/// With fewer operands than this, asking all of them is as fast as searching a tree.
constexpr std::size_t kFewest = 12;
/// Boxes are grown by this share of their coordinates, far more than the rounding of values and
/// distances, so that rounding never excludes the operand that decides.
constexpr double kMargin = 1e-12;

double diagonalOf(const Box3& box) { return box.isBounded() ? glm::length(box.size()) : kInfinity; }

/// A box such that the field at any point outside is at least the point's distance to the box; with
/// `negated` the same for minus the field. All space if no such box is known.
Box3 distanceBox(const Field& field, bool negated) {
  const FieldStructure structure = field.structure();
  switch (structure.kind) {
    case Kind::kComplement:
      return distanceBox(*structure.operands.front(), !negated);
    case Kind::kTransform: {
      const Box3 box = distanceBox(*structure.operands.front(), negated);
      return box.isBounded() ? structure.pose.apply(box) : Box3::everything();
    }
    case Kind::kUnion:
    case Kind::kIntersection: {
      const bool is_minimum = (structure.kind == Kind::kUnion) != negated;
      // The minimum is large only where all operands are, the maximum wherever one is.
      Box3 out = is_minimum ? Box3{} : Box3::everything();
      for (const FieldPtr& operand : structure.operands) {
        const Box3 box = distanceBox(*operand, negated);
        if (is_minimum) {
          out = out.unitedWith(box);
        } else if (diagonalOf(box) < diagonalOf(out)) {
          out = box;
        }
      }
      return out;
    }
    case Kind::kFaces:
    case Kind::kLeaf:
      break;
  }
  const bool is_known = !negated && field.metric() == Metric::kExact && field.bounds().isBounded();
  return is_known ? field.bounds() : Box3::everything();
}

}  // namespace

OperandTree::OperandTree(std::span<const FieldPtr> operands, bool is_minimum)
    : sign_(is_minimum ? 1.0 : -1.0) {
  if (operands.size() < kFewest) return;
  std::vector<Box3> boxes;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const Box3 box = distanceBox(*operands[i], !is_minimum);
    if (!box.isBounded()) {
      always_.push_back(i);
      continue;
    }
    const Vec3 size = glm::max(glm::abs(box.lo), glm::abs(box.hi));
    boxes.push_back(box.grownBy(kMargin * std::max({size.x, size.y, size.z})));
    bounded_.push_back(i);
  }
  if (bounded_.size() >= kFewest) tree_ = BoundsTree(boxes);
}

OperandTree::Found OperandTree::find(std::span<const FieldPtr> operands,
                                     const Vec3& p) const noexcept {
  double least = kInfinity;
  std::size_t index = operands.size();
  const auto ask = [&](std::size_t i) {
    const double value = sign_ * operands[i]->value(p);
    if (value < least || (value == least && i < index)) {
      least = value;
      index = i;
    }
  };
  for (const std::size_t i : always_) ask(i);
  tree_.visitNearest(p, least * (1.0 + kMargin), [&](std::uint32_t item) {
    ask(bounded_[item]);
    return least * (1.0 + kMargin);
  });
  return {sign_ * least, index < operands.size() ? index : 0};
}

}  // namespace palpate::fields
