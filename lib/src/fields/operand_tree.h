#pragma once
/// Which of many operands decides a minimum or maximum at a point, without asking all. Private to
/// fields.

#include <span>
#include <vector>

#include "palpate/core/bounds_tree.h"
#include "palpate/fields/field.h"

namespace palpate::fields {

/// The operands of a minimum (union) or maximum (intersection) by what is known of their values
/// from afar: an exact field is at least as large as the distance to its bounds, a complement of
/// one at most minus that. What nothing is known of is always asked. Immutable; find() is real-time
/// safe.
class OperandTree {
 public:
  struct Found {
    double value = 0.0;     ///< [m]
    std::size_t index = 0;  ///< of the deciding operand; the first of several equal ones
  };

  /// Keeps no operand: find() is given the same ones again.
  OperandTree(std::span<const FieldPtr> operands, bool is_minimum);

  /// True if a search is worth it; else ask all operands.
  [[nodiscard]] bool isUseful() const noexcept { return !tree_.isEmpty(); }

  /// The same as asking all operands, bit for bit, for a finite `p`.
  [[nodiscard]] Found find(std::span<const FieldPtr> operands, const Vec3& p) const noexcept;

 private:
  double sign_;                       ///< of values in a search for the least
  std::vector<std::size_t> always_;   ///< operands that nothing is known of
  std::vector<std::size_t> bounded_;  ///< operand by item of the tree
  BoundsTree tree_;
};

}  // namespace palpate::fields
