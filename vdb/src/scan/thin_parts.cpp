#include "scan/thin_parts.h"

#include <cstdlib>

namespace palpate::vdb {
namespace {

bool isInside(const Mask& mask, const std::array<int, 3>& at) noexcept {
  return mask.inside[static_cast<std::size_t>(mask.at(at[0], at[1], at[2]))] != 0;
}

/// Whether all 2^3 voxels of the cube that begins at `low` are on one side; voxels beyond the image
/// count as on that side.
bool isCube(const Mask& mask, const std::array<int, 3>& low, bool side) noexcept {
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> at = {low[0] + (corner & 1), low[1] + (corner >> 1 & 1),
                                   low[2] + (corner >> 2)};
    if (isIn(mask, at) && isInside(mask, at) != side) return false;
  }
  return true;
}

/// Whether a cube has a voxel of that side next to `at`: one within the image.
bool holdsSide(const Mask& mask, const std::array<int, 3>& low, const std::array<int, 3>& at,
               bool side) noexcept {
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> voxel = {low[0] + (corner & 1), low[1] + (corner >> 1 & 1),
                                      low[2] + (corner >> 2)};
    bool next = isIn(mask, voxel);
    for (std::size_t a = 0; a < 3; ++a) next = next && std::abs(voxel[a] - at[a]) <= 1;
    if (next && isInside(mask, voxel) == side) return true;
  }
  return false;
}

bool isThin(const Mask& mask, const std::array<int, 3>& at, bool side) noexcept {
  // Nearest cubes first: nearly always one of them is all on one side.
  for (const int reach : {1, 2}) {
    for (int n = 0; n < 64; ++n) {
      const std::array<int, 3> step = {n & 3, n >> 2 & 3, n >> 4};
      std::array<int, 3> low{};
      bool near = true;
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = at[a] + step[a] - 2;
        near = near && (step[a] == 1 || step[a] == 2);
      }
      if (near != (reach == 1)) continue;
      if (isCube(mask, low, side) && holdsSide(mask, low, at, side)) return false;
    }
  }
  return true;
}

}  // namespace

bool isIn(const Mask& mask, const std::array<int, 3>& at) noexcept {
  bool in = true;
  for (std::size_t a = 0; a < 3; ++a) in = in && at[a] >= 0 && at[a] < mask.box[a];
  return in;
}

bool isAtThinPart(const Mask& mask, const std::array<int, 3>& at) noexcept {
  const bool side = isInside(mask, at);
  if (isThin(mask, at, side)) return true;
  // A thin part keeps its volume because the surface is held off on both sides of it.
  for (std::size_t a = 0; a < 3; ++a) {
    for (const int step : {-1, 1}) {
      std::array<int, 3> next = at;
      next[a] += step;
      if (isIn(mask, next) && isInside(mask, next) != side && isThin(mask, next, !side)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace palpate::vdb
