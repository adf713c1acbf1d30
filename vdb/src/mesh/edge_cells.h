#pragma once
/// Finds the triangles and sharp edges that may be nearest to a place.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

using MeshTriangle = std::array<std::uint32_t, 3>;

/// The nearest point of a triangle: in its face, on a side or at a corner.
struct NearestPoint {
  Vec3 point{0.0};
  double square = kInfinity;  ///< squared distance
  int feature =
      0;  ///< 0: face; 1 to 3: the side from corner feature - 1; 4 to 6: corner feature - 4
};

[[nodiscard]] NearestPoint nearestOf(const Vec3& a, const Vec3& b, const Vec3& c,
                                     const Vec3& p) noexcept;

/// The nearest point of the segment from a to b.
[[nodiscard]] Vec3 nearestOf(const Vec3& a, const Vec3& b, const Vec3& p) noexcept;

/// Cells of space near sharp edges. Each cell lists triangles that include the nearest one to any
/// point in it, and the edges within reach.
class EdgeCells {
 public:
  struct Lists {
    std::span<const std::uint32_t> triangles;
    std::span<const std::uint32_t> edges;  ///< empty: no sharp edge is within reach
  };

  /// `edges`: pairs of vertices. `reach` [m] from them; `size` [m] of a cell.
  EdgeCells(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles,
            const std::vector<std::array<std::uint32_t, 2>>& edges, double reach, double size);

  /// The lists of the cell that holds a point. Real-time safe.
  [[nodiscard]] Lists at(const Vec3& p) const noexcept;

 private:
  [[nodiscard]] std::uint64_t keyOf(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    return (static_cast<std::uint64_t>(x) << 42) ^ (static_cast<std::uint64_t>(y) << 21) ^
           static_cast<std::uint64_t>(z);
  }

  Vec3 lo_{0.0};
  double size_;
  Box3 box_;
  struct Cell {
    std::uint64_t key = ~std::uint64_t{0};
    std::uint32_t triangles = 0, edges = 0, end = 0;  ///< in lists_: first triangles, then edges
  };
  std::vector<Cell> table_;  ///< hash table with open addressing; its size is a power of two
  std::vector<std::uint32_t> lists_;
};

}  // namespace palpate::vdb
