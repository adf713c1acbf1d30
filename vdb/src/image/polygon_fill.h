#pragma once
/// Which pixels of a slice are inside closed polygons.

#include <cstdint>
#include <utility>
#include <vector>

namespace palpate::vdb {

/// In pixels: pixel (i, j) has its center there.
struct PixelPoint {
  double i = 0.0;
  double j = 0.0;
};

/// Runs of pixels of row `j`, first to before last, whose centers are inside an odd number of the
/// polygons; `columns` in the row. An edge that goes up or down through a center has it on its
/// right.
[[nodiscard]] std::vector<std::pair<int, int>> evenOddRuns(
    const std::vector<std::vector<PixelPoint>>& polygons, int j, int columns);

}  // namespace palpate::vdb
