#include "palpate/vdb/image.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::vdb {

double Image::interpolate(const Vec3& world) const noexcept {
  // A point computed to lie on the border of the box may miss it by round-off; it still counts as
  // inside.
  constexpr double kRoundOff = 1e-9;  // [voxels]
  const Vec3 index = toIndex(world);
  int cell[3];
  double fraction[3];
  for (int a = 0; a < 3; ++a) {
    const double last = size[static_cast<std::size_t>(a)] - 1;
    // Written so that NaN fails too.
    if (!(index[a] >= -kRoundOff && index[a] <= last + kRoundOff)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const double x = std::clamp(index[a], 0.0, last);
    cell[a] = std::max(0, std::min(static_cast<int>(x), static_cast<int>(last) - 1));
    fraction[a] = x - cell[a];
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    int at_corner[3];
    double weight = 1.0;
    for (int a = 0; a < 3; ++a) {
      const int up = (corner >> a) & 1;
      at_corner[a] = cell[a] + up;
      weight *= up != 0 ? fraction[a] : 1.0 - fraction[a];
    }
    // A corner with weight zero is not read: it may be NaN, or beyond the border.
    if (weight > 0.0) {
      sum += weight * static_cast<double>(at(at_corner[0], at_corner[1], at_corner[2]));
    }
  }
  return sum;
}

}  // namespace palpate::vdb
