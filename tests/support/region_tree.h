#pragma once
// The set where a proxy of a scene may be, computed from values of fields alone, without any of
// lib's contact or rendering code.

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "palpate/scene/scene.h"

namespace palpate::testing {

/// One side of one smooth field: allowed where value() >= 0.
struct Literal {
  FieldPtr field;
  double sign = 1.0;  ///< +1: outside the field is allowed, -1: inside
  Pose pose = {};     ///< field's frame -> world
  bool is_moved = false;
  double feature = 1.0;    ///< [m]
  double lipschitz = 1.0;  ///< [-]

  [[nodiscard]] double value(const Vec3& p) const noexcept {
    return sign * field->value(is_moved ? pose.applyInverse(p) : p);
  }
};

/// A literal at one point, linearized by differences of its values.
struct Slope {
  Vec3 normal{0.0, 0.0, 1.0};  ///< unit, towards the allowed side
  double steepness = 1.0;      ///< [-] slope of the value along it
  double gap = 0.0;            ///< [m] value / steepness
  double doubt = 0.0;  ///< [-] error bound of the normal; above kSingular there is no normal
  static constexpr double kSingular = 1e-3;
};

/// The conditions that decide within a ball: its border is a tree of AND and OR over the literals
/// that can change there.
struct Nearby {
  std::vector<int> literals;         ///< those that can change their sign in the ball; at most 32
  std::vector<std::uint32_t> cells;  ///< conjunctions, as a bit for each of `literals`; a point is
                                     ///< allowed if any of them holds
  bool is_too_much = false;          ///< there are more literals or cells than it can hold
};

class RegionTree {
 public:
  /// The set for a proxy in `region`: inside its own layer, and outside all later layers. Considers
  /// walls only: no ports, no sheets, no absent walls.
  RegionTree(const Scene& scene, RegionId region);

  /// [m] Not negative where allowed, computed from the layers' own values; for exact and bound
  /// fields, at most the distance to the border.
  [[nodiscard]] double value(const Vec3& p) const noexcept;

  [[nodiscard]] const std::vector<Literal>& literals() const noexcept { return literals_; }
  /// Computed by differences over at most `widest` [m].
  [[nodiscard]] Slope slopeAt(const Literal& literal, const Vec3& p,
                              double widest = kInfinity) const noexcept;
  /// Whether `slope`, that of the literal at `p`, is the mean of the slopes on both sides of a
  /// crease: differences across the crease all give this mean, which is less steep than either
  /// side.
  [[nodiscard]] bool isOnCrease(const Literal& literal, const Vec3& p,
                                const Slope& slope) const noexcept;
  /// Hessian of value / steepness.
  [[nodiscard]] Mat3 hessianAt(const Literal& literal, const Vec3& p,
                               double steepness) const noexcept;

  /// `out` is overwritten.
  void nearby(const Vec3& center, double radius, Nearby& out) const;

  [[nodiscard]] double feature() const noexcept { return feature_; }  ///< [m] the smallest
  /// [m] A point counts as on a surface within a billionth of the leaf's feature size; this is the
  /// largest of these tolerances.
  [[nodiscard]] double onSurface() const noexcept { return 1e-9 * largest_feature_; }
  [[nodiscard]] std::size_t nodeCount() const noexcept { return nodes_.size(); }

 private:
  enum class Kind : std::uint8_t { kLiteral, kAll, kAny };
  struct Node {
    Kind kind = Kind::kLiteral;
    int literal = 0;
    std::vector<int> operands = {};
  };
  enum class State : std::uint8_t { kAllowed, kForbidden, kOpen };

  /// Whether literals near `center` together allow only a surface or a line, not a region with
  /// volume: their values sum to 0 all around. Labels that touch give such pairs and triples.
  [[nodiscard]] bool leaveNoRoom(const std::array<int, 3>& literals, const Vec3& center) const;
  /// Drops the cells that hold such literals.
  void dropEmpty(const Vec3& center, Nearby& out) const;
  int addField(const FieldPtr& field, double sign, const Pose& pose, bool is_moved);
  int addLiteral(Literal literal);
  State reduce(int node, std::vector<std::uint32_t>& cells, Nearby& out) const;

  struct Layer {
    FieldPtr field;
    double sign = 1.0;
  };
  std::vector<Layer> layers_;
  std::vector<Literal> literals_;
  bool has_both_sides_ = false;  ///< both sides of some field occur
  mutable std::map<std::array<int, 3>, bool>
      leaves_no_room_;  ///< each pair is stored with its second literal twice
  std::vector<Node> nodes_;
  int root_ = 0;
  double feature_ = kInfinity;
  double largest_feature_ = 0.0;
  mutable std::vector<int>
      state_;  ///< for each literal: 1 allowed, -1 forbidden, else 2 + its index in Nearby
};

}  // namespace palpate::testing
