#include "brick/slopes.h"

#include <algorithm>

namespace palpate::vdb {
namespace {

double larger(double a, double b) noexcept { return a < b ? b : a; }

/// The larger of two squares: of the differences between a coefficient and the ones before and
/// after it.
double largerSquare(float before, float here, float after) noexcept {
  const double middle = here;
  const double down = middle - static_cast<double>(before);
  const double up = static_cast<double>(after) - middle;
  return larger(down * down, up * up);
}

}  // namespace

// Row by row, in loops that compilers turn into vector code. Where there is no coefficient before
// or after, the coefficient itself stands for it: the difference is 0.
double steepestSquare(const float* first, std::size_t side,
                      const std::array<std::size_t, 2>& strides) noexcept {
  std::array<double, kMostSide> most{};
  std::array<float, kMostSide + 2> row{};
  for (std::size_t x = 0; x < side; ++x) {
    for (std::size_t y = 0; y < side; ++y) {
      const float* const here = first + x * strides[0] + y * strides[1];
      const float* const left = x > 0 ? here - strides[0] : here;
      const float* const right = x + 1 < side ? here + strides[0] : here;
      const float* const below = y > 0 ? here - strides[1] : here;
      const float* const above = y + 1 < side ? here + strides[1] : here;
      row[0] = here[0];
      std::copy_n(here, side, row.begin() + 1);
      row[side + 1] = here[side - 1];
      for (std::size_t z = 0; z < side; ++z) {
        const double square = largerSquare(left[z], here[z], right[z]) +
                              largerSquare(below[z], here[z], above[z]) +
                              largerSquare(row[z], row[z + 1], row[z + 2]);
        most[z] = larger(most[z], square);
      }
    }
  }
  return *std::max_element(most.begin(), most.end());
}

}  // namespace palpate::vdb
