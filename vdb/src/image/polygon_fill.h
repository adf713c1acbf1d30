#pragma once
/// Finds the pixels of a slice that are inside closed polygons.

#include <cstdint>
#include <utility>
#include <vector>

namespace palpate::vdb {

/// In pixels: the center of pixel (i, j) is at (i, j).
struct PixelPoint {
  double i = 0.0;
  double j = 0.0;
};

/// Runs of pixels of row `j` (first, and one past the last) whose centers are inside an odd number
/// of the polygons; the row has `columns` pixels. A center on an edge that goes up or down counts
/// as right of the edge.
[[nodiscard]] std::vector<std::pair<int, int>> evenOddRuns(
    const std::vector<std::vector<PixelPoint>>& polygons, int j, int columns);

}  // namespace palpate::vdb
