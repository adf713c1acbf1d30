#include "scan/single_walls.h"

#include <cstdlib>

namespace palpate::vdb {
namespace {

/// Indices of the voxels around one: 9 i + 3 j + k, each from 0 to 2.
struct Around {
  std::array<bool, 27> is_open{};
  std::array<bool, 27> is_reached{};
  bool by_edges = false;

  [[nodiscard]] bool isJoined(int a, int b) const noexcept {
    const int steps =
        std::abs(a / 9 - b / 9) + std::abs(a / 3 % 3 - b / 3 % 3) + std::abs(a % 3 - b % 3);
    const bool is_next = std::abs(a / 9 - b / 9) < 2 && std::abs(a / 3 % 3 - b / 3 % 3) < 2 &&
                         std::abs(a % 3 - b % 3) < 2;
    return is_next && steps <= (by_edges ? 2 : 1);
  }
  void spread(int from) noexcept {
    is_reached[static_cast<std::size_t>(from)] = true;
    for (int to = 0; to < 27; ++to) {
      const auto place = static_cast<std::size_t>(to);
      if (is_open[place] && !is_reached[place] && isJoined(from, to)) spread(to);
    }
  }
};

}  // namespace

bool isSingleWall(const Mask& mask, const std::array<int, 3>& at, std::size_t axis) noexcept {
  const std::ptrdiff_t here = mask.at(at[0], at[1], at[2]);
  const std::ptrdiff_t step = mask.strides()[axis];
  const auto is_inside = [&](std::ptrdiff_t place) {
    return mask.inside[static_cast<std::size_t>(place)] != 0;
  };
  const bool side = is_inside(here);
  if (is_inside(here - step) == side || is_inside(here + step) == side) return false;
  Around around;
  around.by_edges = side;  // outside voxels are connected across edges too
  for (int n = 0; n < 27; ++n) {
    const std::ptrdiff_t there =
        mask.at(at[0] + n / 9 - 1, at[1] + n / 3 % 3 - 1, at[2] + n % 3 - 1);
    around.is_open[static_cast<std::size_t>(n)] = is_inside(there) != side;
  }
  constexpr std::size_t kCenter = 13;
  const std::size_t n = axis == 0 ? 9 : axis == 1 ? 3 : 1;
  around.spread(static_cast<int>(kCenter - n));
  return !around.is_reached[kCenter + n];
}

}  // namespace palpate::vdb
