#pragma once
/// Lower bound of the distance from the surface to points that do not answer, from the cells next
/// to these points.

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "brick/brick_view.h"

namespace palpate::vdb {

/// Facts about the cells of a brick that answer, in the order x, y, z.
struct CellBounds {
  static constexpr std::uint8_t kUnknown = 0xFF;
  std::uint8_t steepest[512];  ///< [1/8] upper bound of the slope in the cell; kUnknown: the cell
                               ///< does not answer
  bool surface[512];           ///< the cell may hold the surface
};
void boundCells(const Brick& brick, bool cubic, CellBounds& to) noexcept;

/// A path shorter than a voxel that ends in a cell begins in that cell or in one of the 26 around
/// it. If none of them may hold the surface, no such path comes from the surface. Otherwise the
/// path runs through cells that answer. There |value| grows from 0 no faster than their slopes
/// allow, and where the path leaves them it has at least the least value on the shared faces; both
/// together bound the path's length from below.
class LeastWay {
 public:
  /// `bounds` are those of the bricks at `blocks`, in units of bricks. Both have to outlive it.
  LeastWay(const std::vector<openvdb::Coord>& blocks, const std::vector<CellBounds>& bounds);

  /// Whether brick n has a cell that does not answer beside one that may hold the surface; other
  /// bricks need no look.
  [[nodiscard]] bool matters(std::size_t n) const;
  /// [voxels] Lower bound of the distance from the surface to a point of brick n that does not
  /// answer; at most 1.
  [[nodiscard]] double in(std::size_t n, const Brick& brick, bool cubic) const;

 private:
  using Near = std::array<const CellBounds*, 27>;
  [[nodiscard]] Near around(std::size_t n) const;

  const std::vector<openvdb::Coord>& blocks_;
  const std::vector<CellBounds>& bounds_;
  std::unordered_map<openvdb::Coord, std::size_t, std::hash<openvdb::Coord>> index_;
};

}  // namespace palpate::vdb
