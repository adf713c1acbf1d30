#include "scan/mask.h"

#include <algorithm>
#include <limits>
#include <span>

namespace palpate::vdb {
namespace {

/// Flood fill: turns `from` into `to` in the component of `voxels` around `seed`; returns its size.
std::size_t flood(std::vector<std::uint8_t>& voxels, std::ptrdiff_t seed, std::uint8_t from,
                  std::uint8_t to, std::span<const std::ptrdiff_t> steps,
                  std::vector<std::ptrdiff_t>& stack) {
  const auto size = static_cast<std::ptrdiff_t>(voxels.size());
  std::size_t count = 0;
  stack.assign(1, seed);
  voxels[static_cast<std::size_t>(seed)] = to;
  while (!stack.empty()) {
    const std::ptrdiff_t here = stack.back();
    stack.pop_back();
    ++count;
    for (const std::ptrdiff_t step : steps) {
      const std::ptrdiff_t next = here + step;
      // Inside voxels never lie in the frame. A fill of the outside does reach the frame, and may
      // there step around the end of a row; it then enters the frame again, which is connected
      // anyway.
      if (next < 0 || next >= size || voxels[static_cast<std::size_t>(next)] != from) continue;
      voxels[static_cast<std::size_t>(next)] = to;
      stack.push_back(next);
    }
  }
  return count;
}

/// Whether a voxel value passes; the last result is kept, because label images and quiet air repeat
/// values in long runs.
class CachedTest {
 public:
  explicit CachedTest(const std::function<bool(float)>& test) : test_(test) {}
  bool operator()(float value) {
    if (value != last_) {  // true for NaN too
      last_ = value;
      result_ = test_(value);
    }
    return result_;
  }

 private:
  const std::function<bool(float)>& test_;
  float last_ = std::numeric_limits<float>::quiet_NaN();
  bool result_ = false;
};

}  // namespace

Mask maskOf(const Image& image, const std::function<bool(float)>& test, int margin) {
  const auto [nx, ny, nz] = image.size;
  CachedTest passes(test);
  std::array<int, 3> lo = image.size;
  std::array<int, 3> hi = {-1, -1, -1};
  std::vector<std::uint8_t> passed(image.values.size());
  std::size_t n = 0;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      int first = nx;
      int last = -1;
      for (int i = 0; i < nx; ++i, ++n) {
        if (!passes(image.values[n])) continue;
        passed[n] = 1;
        first = std::min(first, i);
        last = i;
      }
      if (last < 0) continue;
      lo = {std::min(lo[0], first), std::min(lo[1], j), std::min(lo[2], k)};
      hi = {std::max(hi[0], last), std::max(hi[1], j), std::max(hi[2], k)};
    }
  }
  Mask mask;
  if (hi[0] < 0) return mask;
  for (std::size_t a = 0; a < 3; ++a) {
    mask.first[a] = std::max(0, lo[a] - margin);
    mask.box[a] = std::min(image.size[a] - 1, hi[a] + margin) - mask.first[a] + 1;
  }
  mask.inside.resize(static_cast<std::size_t>(mask.box[0] + 2) *
                     static_cast<std::size_t>(mask.box[1] + 2) *
                     static_cast<std::size_t>(mask.box[2] + 2));
  for (int k = 0; k < mask.box[2]; ++k) {
    for (int j = 0; j < mask.box[1]; ++j) {
      const std::ptrdiff_t from =
          mask.first[0] +
          static_cast<std::ptrdiff_t>(nx) *
              (mask.first[1] + j + static_cast<std::ptrdiff_t>(ny) * (mask.first[2] + k));
      std::copy_n(passed.begin() + from, mask.box[0], mask.inside.begin() + mask.at(0, j, k));
    }
  }
  return mask;
}

std::size_t keepLargestPiece(Mask& mask) {
  const auto [x, y, z] = mask.strides();
  const std::ptrdiff_t faces[] = {-z, -y, -x, x, y, z};
  std::vector<std::ptrdiff_t> stack;
  std::size_t pieces = 0;
  std::size_t largest = 0;
  std::ptrdiff_t seed = 0;
  constexpr std::uint8_t kSeen = 2;
  constexpr std::uint8_t kKept = 3;
  for (std::size_t n = 0; n < mask.inside.size(); ++n) {
    if (mask.inside[n] != 1) continue;
    const auto here = static_cast<std::ptrdiff_t>(n);
    const std::size_t count = flood(mask.inside, here, 1, kSeen, faces, stack);
    ++pieces;
    if (count > largest) {
      largest = count;
      seed = here;
    }
  }
  if (pieces > 0) flood(mask.inside, seed, kSeen, kKept, faces, stack);
  for (std::uint8_t& voxel : mask.inside) voxel = voxel == kKept ? 1 : 0;
  return pieces;
}

std::size_t fillCavities(Mask& mask) {
  if (mask.inside.empty()) return 0;
  const auto [x, y, z] = mask.strides();
  const std::ptrdiff_t faces_and_edges[] = {-z,     -y,     -x,     x,      y,      z,
                                            -z - y, -z - x, -z + x, -z + y, -y - x, -y + x,
                                            y - x,  y + x,  z - y,  z - x,  z + x,  z + y};
  constexpr std::uint8_t kOpen = 2;
  std::vector<std::ptrdiff_t> stack;
  flood(mask.inside, 0, 0, kOpen, faces_and_edges, stack);  // index 0 lies in the frame
  std::size_t filled = 0;
  for (std::uint8_t& voxel : mask.inside) {
    filled += voxel == 0 ? 1U : 0U;
    voxel = voxel == kOpen ? 0 : 1;
  }
  return filled;
}

}  // namespace palpate::vdb
