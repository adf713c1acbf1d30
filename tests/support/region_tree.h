#pragma once
// Where a proxy of a scene may be, asked of values of fields alone: nothing of lib's contact or
// rendering.

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

/// A literal at one point, by differences of its values.
struct Slope {
  Vec3 normal{0.0, 0.0, 1.0};  ///< unit, to where it is allowed
  double steepness = 1.0;      ///< [-] of the value along it
  double gap = 0.0;            ///< [m] value / steepness
  double doubt = 0.0;  ///< [-] by how much the normal may be off; above kSingular there is none
  static constexpr double kSingular = 1e-3;
};

/// What decides within a ball: the border is a tree of AND and OR over the literals that come into
/// it.
struct Nearby {
  std::vector<int> literals;  ///< that can change their sign in the ball; at most 32
  std::vector<std::uint32_t>
      cells;                 ///< conjunctions, a bit for each of `literals`; any of them allows
  bool is_too_much = false;  ///< more literals or cells than it can list
};

class RegionTree {
 public:
  /// What a proxy in `region` must not leave: its own layer, and no later layer may hold it. Walls
  /// only: no ports, no sheets, no absent walls.
  RegionTree(const Scene& scene, RegionId region);

  /// At least 0 where allowed [m], by the layers' own values; at most the distance to the border,
  /// for exact and bound fields.
  [[nodiscard]] double value(const Vec3& p) const noexcept;

  [[nodiscard]] const std::vector<Literal>& literals() const noexcept { return literals_; }
  /// By differences over `widest` [m] at most.
  [[nodiscard]] Slope slopeAt(const Literal& literal, const Vec3& p,
                              double widest = kInfinity) const noexcept;
  /// Whether `slope`, of the literal at `p`, is the mean of those on both sides of a crease:
  /// differences across it agree in that, which is less steep than either.
  [[nodiscard]] bool isOnCrease(const Literal& literal, const Vec3& p,
                                const Slope& slope) const noexcept;
  /// Of value / steepness.
  [[nodiscard]] Mat3 hessianAt(const Literal& literal, const Vec3& p,
                               double steepness) const noexcept;

  /// `out` is overwritten.
  void nearby(const Vec3& center, double radius, Nearby& out) const;

  [[nodiscard]] double feature() const noexcept { return feature_; }  ///< [m] the smallest
  /// [m] Being on a surface means within a billionth of its leaf's feature size; the largest of
  /// those.
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

  /// Whether literals that come near `center` ask for a surface or a line together, not for a place
  /// to be: their values sum to 0 all around. Labels that touch have such pairs and triples.
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
  bool has_both_sides_ = false;  ///< some field is asked for on either side of it
  mutable std::map<std::array<int, 3>, bool>
      leaves_no_room_;  ///< pairs have their second literal twice
  std::vector<Node> nodes_;
  int root_ = 0;
  double feature_ = kInfinity;
  double largest_feature_ = 0.0;
  mutable std::vector<int>
      state_;  ///< by literal: 1 allowed, -1 forbidden, else 2 + its place nearby
};

}  // namespace palpate::testing
