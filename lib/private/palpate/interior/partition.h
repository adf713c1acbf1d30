#pragma once
/// Space divided into regions. Each layer is a Boolean expression over smooth leaf fields. The
/// leaves' signs at a point decide which layers contain it, and the last of those layers is its
/// region.

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "palpate/core/bounds_tree.h"
#include "palpate/fields/field.h"
#include "palpate/interior/port.h"

namespace palpate {

/// One smooth field of the partition, in world coordinates, never complemented or combined.
struct Leaf {
  FieldPtr field;
  double lipschitz = 1.0;  ///< Field::lipschitz()
  /// [m] the length that tolerances at this leaf are relative to: Field::featureSize(); for a
  /// plane, that of the solid it is a face of, or else the largest of the other leaves
  double feature = 1.0;
  bool is_flat = false;  ///< Field::isFlat()
  /// Set for a leaf between two others, which has a meaning only where both of these are inside.
  /// Where only one of them is, this leaf counts as inside with the first and as outside with the
  /// second.
  bool is_between = false;
  std::array<LeafId, 2> ends{};
};

/// States that `wall` is a leaf between `first` and `second`: all three vanish on one line, and
/// without this information rounding could produce cells there that do not exist. Ignored if one of
/// the two is not a single leaf.
struct LeafBetween {
  FieldPtr wall;
  FieldPtr first;   ///< inside wherever the wall is inside and `second` is
  FieldPtr second;  ///< inside wherever the wall is outside and `first` is
};

/// One bit for each leaf: true is inside (negative). A value type with room for as many leaves as a
/// scene may have.
class Signs {
 public:
  static constexpr std::size_t kMaxLeaves = 65535;

  Signs() = default;
  /// `leaves` is at most kMaxLeaves.
  explicit Signs(std::size_t leaves) noexcept
      : leaves_(static_cast<std::uint32_t>(leaves)),
        used_(static_cast<std::uint32_t>((leaves + 63) / 64)) {}

  [[nodiscard]] std::size_t size() const noexcept { return leaves_; }
  /// Whether these can be the signs of that many leaves: a value from a file need not be.
  [[nodiscard]] bool isOf(std::size_t leaves) const noexcept;

  /// Like the defaulted copy, without copying the words that are not used.
  void assign(const Signs& other) noexcept {
    leaves_ = other.leaves_;
    used_ = other.used_;
    for (std::size_t w = 0; w < used_; ++w) words_[w] = other.words_[w];
  }

  [[nodiscard]] bool inside(LeafId leaf) const noexcept {
    return ((words_[leaf >> 6U] >> (leaf & 63U)) & 1U) != 0;
  }
  void set(LeafId leaf, bool inside) noexcept {
    const std::uint64_t bit = std::uint64_t{1} << (leaf & 63U);
    words_[leaf >> 6U] = inside ? (words_[leaf >> 6U] | bit) : (words_[leaf >> 6U] & ~bit);
  }
  void flip(LeafId leaf) noexcept { words_[leaf >> 6U] ^= std::uint64_t{1} << (leaf & 63U); }
  void clear() noexcept {
    for (std::size_t w = 0; w < used_; ++w) words_[w] = 0;
  }
  /// Calls f(leaf) for every leaf that is inside.
  template <typename F>
  void forInside(F&& f) const {
    for (std::size_t w = 0; w < used_; ++w) {
      for (std::uint64_t rest = words_[w]; rest != 0; rest &= rest - 1) {
        f(static_cast<LeafId>(64 * w + static_cast<std::size_t>(std::countr_zero(rest))));
      }
    }
  }
  /// Number of leaves inside, among the `count` leaves from `first` on.
  [[nodiscard]] std::size_t countInside(LeafId first, std::size_t count) const noexcept;
  /// True if any (all) of `count` leaves from `first` on are inside.
  [[nodiscard]] bool anyInside(LeafId first, std::size_t count) const noexcept;
  [[nodiscard]] bool allInside(LeafId first, std::size_t count) const noexcept;
  friend bool operator==(const Signs& a, const Signs& b) noexcept {
    if (a.leaves_ != b.leaves_) return false;
    for (std::size_t w = 0; w < a.used_; ++w) {
      if (a.words_[w] != b.words_[w]) return false;
    }
    return true;
  }

 private:
  std::array<std::uint64_t, (kMaxLeaves + 63) / 64> words_{};
  std::uint32_t leaves_ = 0;
  std::uint32_t used_ = 0;  ///< words
};

static_assert(std::is_trivially_copyable_v<Signs>);

/// One step of an expression in postfix order whose negations are all at the leaves. kAnyOf and
/// kAllOf push whether any or all leaves of a run (or a single leaf) are on the side `inside`; kAnd
/// and kOr combine the two topmost stack entries.
struct SideStep {
  enum class Op : std::uint8_t { kAnyOf, kAllOf, kAnd, kOr } op = Op::kAnyOf;
  bool inside = true;       ///< of a run: the side of its leaves that is tested
  LeafId first = 0;         ///< of a run
  std::uint16_t count = 0;  ///< of a run; 1 for a leaf, 0 for none: then any is false, all is true
};

/// Leaves and the layers' expressions over them. Immutable; every const member is real-time safe.
class Partition {
 public:
  /// Splits each layer's field along its CSG structure, and each mask's likewise. A mask is the
  /// extent of a port or sheet: its leaves divide cells, but it does not contain a region. A leaf
  /// that several of them use (the same field at the same place) is one leaf. A layer without a
  /// field (null) contains nothing. @throws Error (kInput) for more leaves or layers than the id
  /// types can number.
  explicit Partition(std::span<const FieldPtr> layers, std::span<const FieldPtr> masks = {},
                     std::span<const LeafBetween> between = {});

  [[nodiscard]] std::span<const Leaf> leaves() const noexcept { return leaves_; }
  [[nodiscard]] std::size_t regionCount() const noexcept { return layer_count_ + 1; }

  /// The leaves into which the constructor split `part`, a field that occurs in a layer's field;
  /// empty if it occurs in none. This is how `on: brim` finds its facet.
  [[nodiscard]] std::vector<LeafId> leavesOf(const Field* part) const;

  /// Leaves of the expression of `region`'s layer, without repetition.
  [[nodiscard]] std::span<const LeafId> leavesOfRegion(RegionId region) const noexcept;

  /// Regions whose layer's expression uses `leaf`.
  [[nodiscard]] std::span<const RegionId> regionsOf(LeafId leaf) const noexcept {
    return regions_of_leaf_[leaf];
  }

  /// Leaves that lie between `leaf` and another one.
  [[nodiscard]] std::span<const LeafId> between(LeafId leaf) const noexcept {
    return between_[leaf];
  }

  /// A tree over the boxes of the leaves' insides: its items are leaf ids.
  [[nodiscard]] const BoundsTree& tree() const noexcept { return tree_; }

  /// True if `region`'s own layer (ignoring later layers) contains the cell `signs`; true for
  /// outside.
  [[nodiscard]] bool layerHolds(RegionId region, const Signs& signs) const noexcept;

  /// True if the cell `signs` lies within mask `index` (of the constructor's list).
  [[nodiscard]] bool maskHolds(std::size_t index, const Signs& signs) const noexcept;

  /// The last layer that contains the cell, or outside.
  [[nodiscard]] RegionId regionOf(const Signs& signs) const noexcept;

  /// The steps that evaluate whether a cell is in `region`'s own layer (`holds`), or is not in it.
  /// `region` must not be outside.
  [[nodiscard]] std::span<const SideStep> layerSides(RegionId region, bool holds) const noexcept {
    return sides_[region - 1U][holds ? 1 : 0];
  }
  /// The same for mask `index`.
  [[nodiscard]] std::span<const SideStep> maskSides(std::size_t index, bool holds) const noexcept {
    return sides_[layer_count_ + index][holds ? 1 : 0];
  }
  /// The most stack entries that evaluating any of these takes.
  static constexpr std::size_t kMaxDepth = 64;

  /// Signs of all leaves at `p` [m]; zero counts as outside. `out` must have room for all leaves.
  void signsAt(const Vec3& p, Signs& out) const noexcept;

 private:
  /// A step of a program in postfix order: leaves push their sign, or the union or intersection of
  /// a run of leaves; kAnd and kOr combine the two topmost entries.
  struct Step {
    enum class Op : std::uint8_t { kLeaf, kAnyOf, kAllOf, kAnd, kOr, kNot } op;
    LeafId leaf = 0;          ///< the leaf, or the first of a run
    std::uint16_t count = 0;  ///< of a run
  };
  struct Program {
    std::vector<Step> steps;
    std::vector<LeafId> leaves;
  };
  struct Builder;
  /// For one program: where it does not hold, and where it does.
  using Sides = std::array<std::vector<SideStep>, 2>;
  [[nodiscard]] static Sides sidesOf(const Program& program);

  [[nodiscard]] static bool evaluate(const Program& program, const Signs& signs) noexcept;

  std::vector<Leaf> leaves_;
  std::vector<Program> programs_;  ///< of the layers, then of the masks
  std::vector<Sides> sides_;       ///< by program
  std::size_t layer_count_ = 0;
  std::vector<std::vector<RegionId>> regions_of_leaf_;
  std::vector<std::vector<LeafId>> between_;  ///< by either of the two leaves that it lies between
  std::vector<RegionId>
      hold_empty_;  ///< regions that contain the cell outside all leaves (complements)
  BoundsTree tree_;
  std::vector<std::pair<const Field*, std::vector<LeafId>>> parts_;
};

}  // namespace palpate
