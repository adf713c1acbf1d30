#pragma once
/// A field's CSG taken apart, so that in a cell only those operands are asked that can matter
/// there.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "palpate/fields/field.h"

namespace palpate::vdb {

/// What is left of a field in some cell: nodes in preorder, each with how many belong to it.
struct FieldPart {
  struct Node {
    std::uint32_t which = 0;  ///< index into FieldParts
    std::uint32_t size = 1;   ///< of it and all below it
  };
  std::vector<Node> nodes;
  std::vector<double> least;  ///< [m] scratch of narrow()
};

/// Where the values in a ball lie, by the Lipschitz bounds of the operands: no less than `lo`, no
/// more than `hi` [m]; infinite where nothing is known.
struct ValueRange {
  double lo = 0.0;
  double hi = 0.0;
};

/// Unions, intersections, complements and placements; all else is a leaf. Refers to the field, and
/// never changes; any number of threads may ask.
class FieldParts {
 public:
  explicit FieldParts(const Field& field);

  [[nodiscard]] const FieldPart& whole() const noexcept { return whole_; }

  /// Puts into `to` what decides about the value somewhere in the ball, out of what did so in a
  /// ball that holds it. The values there stay the same, bit for bit; but those beyond +-`limit`
  /// [m] may become others beyond it with the same sign.
  ValueRange narrow(const FieldPart& from, const Vec3& center, double radius, double limit,
                    FieldPart& to) const;

  /// Whether the part is a union of leaves, placed as they may be, each of which `is_good`.
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
