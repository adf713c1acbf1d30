#include "scan/nearest_feet.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace palpate::vdb {

NearestFeet::NearestFeet(const Mat3& axes) noexcept {
  for (int n = 0; n < 27; ++n) {
    const auto place = static_cast<std::size_t>(n);
    const int x = n / 9 - 1;
    const int y = n / 3 % 3 - 1;
    const int z = n % 3 - 1;
    const Vec3 step = axes * Vec3(x, y, z);
    for (int a = 0; a < 3; ++a) {
      steps_[place][static_cast<std::size_t>(a)] = static_cast<float>(step[a]);
    }
    places_[place] = at(x, y, z) - at(0, 0, 0);
  }
}

void NearestFeet::gather(const std::array<const Feet*, 27>& around) noexcept {
  alignas(32) static constexpr std::array<float, 512> kNoFeet = [] {
    std::array<float, 512> none{};
    none.fill(Feet::kNone);
    return none;
  }();
  for (std::size_t a = 0; a < 3; ++a) {
    for (int x = -1; x < 9; ++x) {
      const int dx = x < 0 ? 0 : x > 7 ? 2 : 1;
      for (int y = -1; y < 9; ++y) {
        const int dy = y < 0 ? 0 : y > 7 ? 2 : 1;
        const int row = ((x & 7) << 6) | ((y & 7) << 3);
        const auto source = [&](int dz) {
          const int place = 9 * dx + 3 * dy + dz;
          const Feet* const feet = around[static_cast<std::size_t>(place)];
          return (feet == nullptr ? kNoFeet : feet->from[a]).data() + row;
        };
        float* const to = feet_[a].data() + at(x, y, 0);
        to[-1] = source(0)[7];
        std::memcpy(to, source(1), 8 * sizeof(float));
        to[8] = source(2)[0];
      }
    }
  }
}

void NearestFeet::find(const std::array<const Feet*, 27>& around, std::uint64_t rows) noexcept {
  gather(around);
  for (; rows != 0; rows &= rows - 1) {
    const int row = std::countr_zero(rows);
    const int here = at(row >> 3, row & 7, 0);
    alignas(32) float best[8];
    alignas(32) float which[8];
    std::fill_n(best, 8, Feet::kNone);
    std::fill_n(which, 8, 0.0F);
    for (std::size_t n = 0; n < 27; ++n) {
      const float* const x = feet_[0].data() + here + places_[n];
      const float* const y = feet_[1].data() + here + places_[n];
      const float* const z = feet_[2].data() + here + places_[n];
      const auto [u, v, w] = steps_[n];
      const auto number = static_cast<float>(n);
      for (int lane = 0; lane < 8; ++lane) {
        const float a = x[lane] + u;
        const float b = y[lane] + v;
        const float c = z[lane] + w;
        const float square = a * a + b * b + c * c;
        const bool less = square < best[lane];
        best[lane] = less ? square : best[lane];
        which[lane] = less ? number : which[lane];
      }
    }
    std::copy_n(best, 8, square_.data() + std::ptrdiff_t{8} * row);
    std::copy_n(which, 8, which_.data() + std::ptrdiff_t{8} * row);
  }
}

Vec3 NearestFeet::foot(std::size_t place) const noexcept {
  const auto n = static_cast<std::size_t>(which_[place]);
  const auto voxel = static_cast<int>(place);
  const int from = at(voxel >> 6, voxel >> 3 & 7, voxel & 7) + places_[n];
  Vec3 result(0.0);
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    result[a] = static_cast<double>(feet_[axis][static_cast<std::size_t>(from)]) +
                static_cast<double>(steps_[n][axis]);
  }
  return result;
}

}  // namespace palpate::vdb
