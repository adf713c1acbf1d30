#include "brick/slopes.h"

#include <algorithm>

namespace palpate::vdb {

double steepestSquare(const float* first, std::size_t side,
                      const std::array<std::size_t, 3>& strides) noexcept {
  const auto square = [](const float* low, std::size_t stride) {
    const double step = static_cast<double>(low[stride]) - static_cast<double>(*low);
    return step * step;
  };
  // The larger of the squares of the differences before and after a coefficient, as far as they are there.
  const auto larger = [&](const float* at, std::size_t place, std::size_t stride) {
    const double before = place > 0 ? square(at - stride, stride) : 0.0;
    const double after = place + 1 < side ? square(at, stride) : 0.0;
    return std::max(before, after);
  };
  double most = 0.0;
  for (std::size_t x = 0; x < side; ++x) {
    for (std::size_t y = 0; y < side; ++y) {
      const float* const row = first + x * strides[0] + y * strides[1];
      for (std::size_t z = 0; z < side; ++z) {
        const float* const at = row + z * strides[2];
        most = std::max(most, larger(at, x, strides[0]) + larger(at, y, strides[1]) +
                                  larger(at, z, strides[2]));
      }
    }
  }
  return most;
}

}  // namespace palpate::vdb
