#pragma once
/// Finds which of many operands decides a minimum or maximum at a point, without asking all.
/// Private to fields.

#include <span>
#include <vector>

#include "palpate/core/bounds_tree.h"
#include "palpate/fields/field.h"

namespace palpate::fields {

/// The operands of a minimum (union) or maximum (intersection), sorted by bounds on their values:
/// an exact field is at least the distance to its bounds, a complement of one at most minus that.
/// An operand without a known bound is always asked. Immutable; find() is real-time safe.
class OperandTree {
 public:
  struct Found {
    double value = 0.0;     ///< [m]
    std::size_t index = 0;  ///< index of the deciding operand; the first of several equal ones
  };

  /// Does not store the operands: find() must be given the same ones again.
  OperandTree(std::span<const FieldPtr> operands, bool is_minimum);

  /// True if a search is faster; otherwise ask all operands.
  [[nodiscard]] bool isUseful() const noexcept { return !tree_.isEmpty(); }

  /// The same as asking all operands, bit for bit, for a finite `p`.
  [[nodiscard]] Found find(std::span<const FieldPtr> operands, const Vec3& p) const noexcept;

 private:
  double sign_;  ///< -1 if the largest value is searched for, since the search finds the least
  std::vector<std::size_t> always_;   ///< operands without a known bound
  std::vector<std::size_t> bounded_;  ///< by item of the tree: its operand
  BoundsTree tree_;
};

}  // namespace palpate::fields
