#pragma once
/// How far it is from a surface to points that do not answer, by the cells next to these points.

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "brick/brick_view.h"

namespace palpate::vdb {

/// Of the cells of a brick that answer, in the order x, y, z.
struct CellBounds {
  static constexpr std::uint8_t kUnknown = 0xFF;
  std::uint8_t
      steepest[512];  ///< [1/8] no slope in the cell is above that; kUnknown: it does not answer
  bool surface[512];  ///< the cell may hold the surface
};
void boundCells(const Brick& brick, bool cubic, CellBounds& to) noexcept;

/// A way shorter than a voxel that ends in a cell begins in it or in one of the 26 around. If none
/// of them may hold the surface, no such way comes from the surface. Otherwise it comes from cells
/// that answer, on which |value| rises by no more than their slopes let it, to what |value| is at
/// least where it leaves them.
class LeastWay {
 public:
  /// `bounds` are those of the bricks at `blocks`, in units of bricks. Both have to outlive it.
  LeastWay(const std::vector<openvdb::Coord>& blocks, const std::vector<CellBounds>& bounds);

  /// Whether brick n has a cell that does not answer beside one that may hold the surface: others
  /// need no look.
  [[nodiscard]] bool matters(std::size_t n) const;
  /// [voxels] So far is it at least from the surface to a point of brick n that does not answer; 1
  /// at most.
  [[nodiscard]] double in(std::size_t n, const Brick& brick, bool cubic) const;

 private:
  using Near = std::array<const CellBounds*, 27>;
  [[nodiscard]] Near around(std::size_t n) const;

  const std::vector<openvdb::Coord>& blocks_;
  const std::vector<CellBounds>& bounds_;
  std::unordered_map<openvdb::Coord, std::size_t, std::hash<openvdb::Coord>> index_;
};

}  // namespace palpate::vdb
