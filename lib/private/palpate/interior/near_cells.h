#pragma once
/// The convex pieces that make up a region near a point: the region's expression over the few
/// leaves whose surfaces are near, with all other leaves at their present sides.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/interior/partition.h"
#include "palpate/interior/port_machine.h"

namespace palpate {

/// A conjunction of sides of near leaves, one bit for each of them. With no bit set it holds
/// everywhere near the point.
struct NearCell {
  std::uint32_t inside = 0;   ///< near leaves on whose inside the cell is
  std::uint32_t outside = 0;  ///< near leaves on whose outside the cell is

  [[nodiscard]] bool isEverywhere() const noexcept { return (inside | outside) == 0; }
  /// True if every point of `other` is in this cell.
  [[nodiscard]] bool contains(const NearCell& other) const noexcept {
    return (inside & ~other.inside) == 0 && (outside & ~other.outside) == 0;
  }
  friend bool operator==(const NearCell&, const NearCell&) = default;
};

/// A leaf near the point, and the sides on which the point may be taken to lie: both if it is on
/// the leaf's surface.
struct NearSide {
  LeafId leaf = 0;
  bool may_be_inside = true;
  bool may_be_outside = true;
};

/// Scratch of one solver. Real-time safe except for the constructor.
class NearCells {
 public:
  static constexpr std::size_t kMaxNear = 32;  ///< bits of NearCell
  /// more are left out, which is safe: cells are places where the point may go
  static constexpr std::size_t kMaxCells = 24;

  NearCells(const Partition& partition, const Passages& passages);

  /// The cells of `region` that contain the point: the disjunctive normal form of where the region
  /// and its sheets permit the point to be, in which no cell contains another. `signs` are the
  /// sides of all leaves, as the point counts them; `near` has at most kMaxNear entries. Empty if
  /// no cell contains the point.
  [[nodiscard]] std::span<const NearCell> find(RegionId region, const Signs& signs,
                                               std::span<const NearSide> near) noexcept;

 private:
  struct List {
    std::array<NearCell, kMaxCells> cell{};
    std::size_t count = 0;

    void add(const NearCell& cell) noexcept;
  };
  void evaluate(std::span<const SideStep> steps, const Signs& signs, std::span<const NearSide> near,
                List& out) noexcept;
  void run(const SideStep& step, const Signs& signs, std::span<const NearSide> near,
           List& out) const noexcept;
  static void intersect(const List& a, const List& b, List& out) noexcept;

  const Partition& partition_;
  const Passages& passages_;
  std::vector<std::int8_t> index_;  ///< by leaf: its index among the near ones, or -1
  std::vector<RegionId> later_;     ///< layers that may own the point's place instead
  std::array<List, Partition::kMaxDepth> stack_{};
  List cells_;
  List other_;
  List product_;
};

}  // namespace palpate
