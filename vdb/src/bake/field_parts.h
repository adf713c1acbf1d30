#pragma once
/// A field's CSG taken apart, so that in a cell only the operands that can matter there are asked.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "palpate/fields/field.h"

namespace palpate::vdb {

/// The operands of a field that matter in some cell: nodes in preorder, each with the size of its
/// subtree.
struct FieldPart {
  struct Node {
    std::uint32_t which = 0;  ///< index into FieldParts
    std::uint32_t size = 1;   ///< number of nodes: itself and all below it
  };
  std::vector<Node> nodes;
  std::vector<double> least;  ///< [m] scratch of narrow()
};

/// Range of the values in a ball, by the Lipschitz bounds of the operands: at least `lo`, at most
/// `hi` [m]; infinite where nothing is known.
struct ValueRange {
  double lo = 0.0;
  double hi = 0.0;
};

/// Takes unions, intersections, complements and placements apart; everything else is a leaf. Refers
/// to the field, and never changes; any number of threads may use it.
class FieldParts {
 public:
  explicit FieldParts(const Field& field);

  [[nodiscard]] const FieldPart& whole() const noexcept { return whole_; }

  /// Puts into `to` the operands that decide the value somewhere in the ball; `from` holds those of
  /// a larger ball around it. Values in the ball stay the same, bit for bit, except that those
  /// beyond +-`limit` [m] may become other values beyond it with the same sign.
  ValueRange narrow(const FieldPart& from, const Vec3& center, double radius, double limit,
                    FieldPart& to) const;

  /// Whether the part is a union of leaves, placed in whatever way, each of which `is_good`.
  template <class Test>
  [[nodiscard]] bool isUnionOf(const FieldPart& part, const Test& is_good) const {
    return std::all_of(part.nodes.begin(), part.nodes.end(), [&](const FieldPart::Node& node) {
      const Item& item = items_[node.which];
      if (item.kind == FieldStructure::Kind::kLeaf) return is_good(*item.field);
      return item.kind == FieldStructure::Kind::kUnion ||
             item.kind == FieldStructure::Kind::kTransform;
    });
  }

  /// Field::sample(), value() and values() of the part.
  [[nodiscard]] FieldSample sample(const FieldPart& part, const Vec3& p) const noexcept;
  [[nodiscard]] double value(const FieldPart& part, const Vec3& p) const noexcept;
  void values(const FieldPart& part, const PointBatch& points, ValueBatch& out) const noexcept;

 private:
  struct Item {
    const Field* field = nullptr;
    FieldStructure::Kind kind = FieldStructure::Kind::kLeaf;
    Pose pose;  ///< of a placement
    double lipschitz = 1.0;
    bool is_bounded_everywhere = false;
    Box3 lipschitz_domain;
  };

  void take(const Field& field);
  [[nodiscard]] ValueRange rangeOf(const Field& leaf, const Item& item, const Vec3& center,
                                   double radius) const noexcept;
  ValueRange narrowNode(const FieldPart& from, std::size_t at, const Vec3& center, double radius,
                        double limit, FieldPart& to) const;
  template <class Ask>
  [[nodiscard]] typename Ask::Answer askNode(const FieldPart& part, std::size_t at, const Vec3& p,
                                             const Ask& ask) const noexcept;
  void valuesOfNode(const FieldPart& part, std::size_t at, const PointBatch& points,
                    ValueBatch& out) const noexcept;

  std::vector<Item> items_;
  FieldPart whole_;
};

}  // namespace palpate::vdb
