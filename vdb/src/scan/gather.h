#pragma once
/// Gathers a block of a band with its surroundings, for the loops of relax.h.

#include <array>
#include <cstring>
#include <limits>

#include "scan/band.h"
#include "scan/relax.h"

namespace palpate::vdb {

/// Copies the block, and the parts of its neighbors that the stencils reach; of(b) returns the
/// values of block b.
template <typename Of>
void gather(const BandBlock& block, const Of& of, Patch& patch) noexcept {
  alignas(32) static constexpr BandBlock::Values kNoBlock = [] {
    BandBlock::Values none{};
    none.fill(std::numeric_limits<float>::quiet_NaN());
    return none;
  }();
  std::array<const float*, 27> sources{};
  for (std::size_t n = 0; n < 27; ++n) {
    const std::int32_t b = block.near[n];
    sources[n] = b < 0 ? kNoBlock.data() : of(static_cast<std::size_t>(b)).data();
  }
  const auto source = [&](int dx, int dy, int dz) {
    const int place = 9 * dx + 3 * dy + dz + 13;
    return sources[static_cast<std::size_t>(place)];
  };
  const auto copy = [&]<int kCount>(std::integral_constant<int, kCount>, const float* from, int x,
                                    int y, int z) {
    std::memcpy(patch.values + Patch::at(x, y, z), from + Band::placeOf(x, y, z),
                kCount * sizeof(float));
  };
  constexpr std::integral_constant<int, 8> kRow;
  constexpr std::integral_constant<int, Patch::kHalo> kEnd;
  // Rows of the block, and of the blocks across its faces; nearer ones include their ends.
  const auto columns = [&](int dx, int dy, int x0, int x1, int y0, int y1, bool with_ends) {
    const float* const here = source(dx, dy, 0);
    const float* const before = source(dx, dy, -1);
    const float* const behind = source(dx, dy, 1);
    for (int x = x0; x < x1; ++x) {
      for (int y = y0; y < y1; ++y) {
        copy(kRow, here, x, y, 0);
        if (!with_ends) continue;
        copy(kEnd, before, x, y, -Patch::kHalo);
        copy(kEnd, behind, x, y, 8);
      }
    }
  };
  columns(0, 0, 0, 8, 0, 8, true);
  columns(-1, 0, -1, 0, 0, 8, true);
  columns(1, 0, 8, 9, 0, 8, true);
  columns(0, -1, 0, 8, -1, 0, true);
  columns(0, 1, 0, 8, 8, 9, true);
  columns(-1, 0, -2, -1, 0, 8, false);
  columns(1, 0, 9, 10, 0, 8, false);
  columns(0, -1, 0, 8, -2, -1, false);
  columns(0, 1, 0, 8, 9, 10, false);
  for (const int dx : {-1, 1}) {
    for (const int dy : {-1, 1}) copy(kRow, source(dx, dy, 0), dx < 0 ? -1 : 8, dy < 0 ? -1 : 8, 0);
  }
}

}  // namespace palpate::vdb
