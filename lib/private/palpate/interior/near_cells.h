#pragma once
/// The convex pieces that a region is made of near a point: its expression over the few leaves
/// whose surfaces are near, all other leaves being where they are.

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
  std::uint32_t inside = 0;   ///< these near leaves' insides
  std::uint32_t outside = 0;  ///< these near leaves' outsides

  [[nodiscard]] bool isEverywhere() const noexcept { return (inside | outside) == 0; }
  /// True if every point of `other` is one of this cell.
  [[nodiscard]] bool contains(const NearCell& other) const noexcept {
    return (inside & ~other.inside) == 0 && (outside & ~other.outside) == 0;
  }
  friend bool operator==(const NearCell&, const NearCell&) = default;
};

/// A leaf near the point, and on which sides of it the point may be taken to lie: both on its
/// surface.
struct NearSide {
  LeafId leaf = 0;
  bool may_be_inside = true;
  bool may_be_outside = true;
};

/// Scratch of one solver. Real-time safe but for the constructor.
class NearCells {
 public:
  static constexpr std::size_t kMaxNear = 32;   ///< bits of NearCell
  static constexpr std::size_t kMaxCells = 24;  ///< more are left out, which is safe: cells are
                                                ///< where the point may go

  NearCells(const Partition& partition, const Passages& passages);

  /// The cells of `region` that hold the point, of the disjunctive form of where the region and its
  /// sheets let the point be: none contains another. `signs`: of all leaves, as the point knows
  /// them; `near`: at most kMaxNear. Empty if no cell holds the point.
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
  std::vector<std::int8_t> index_;  ///< by leaf: among the near ones, -1 elsewhere
  std::vector<RegionId> later_;     ///< layers that may take the point's place
  std::array<List, Partition::kMaxDepth> stack_{};
  List cells_;
  List other_;
  List product_;
};

}  // namespace palpate
