// The search of leaf_distance.h over eight lanes: a kernel, as simd.h says. It uses no code of the
// standard library, so that no inline function of another header is compiled for a newer processor
// than the least one.

#include "bake/leaf_distance.h"
#include "simd.h"

namespace palpate::vdb {
namespace {

using Lanes = Floats;

/// The sign of each of eight parts along x, y and z.
PALPATE_KERNEL Lanes xSigns(float s) noexcept { return Lanes{-s, -s, -s, -s, s, s, s, s}; }
PALPATE_KERNEL Lanes ySigns(float s) noexcept { return Lanes{-s, -s, s, s, -s, -s, s, s}; }
PALPATE_KERNEL Lanes zSigns(float s) noexcept { return Lanes{-s, s, -s, s, -s, s, -s, s}; }

/// n . (x, y, z) + offset
PALPATE_KERNEL Lanes planeOf(const float* n, const Lanes& offset, const Lanes& x, const Lanes& y,
                             const Lanes& z) noexcept {
  return fma(all(n[0]), x, fma(all(n[1]), y, fma(all(n[2]), z, offset)));
}

/// Squares of the distances from eight points to a facet.
PALPATE_KERNEL Lanes squaresOf(const Facet& f, const Lanes& x, const Lanes& y,
                               const Lanes& z) noexcept {
  const Lanes zero = all(0.0F);
  Lanes outermost = zero;
  Lanes beyond_longest = zero;
  Lanes least = zero;
  for (int n = 0; n < 3; ++n) {
    const Lanes out = planeOf(f.out[n], all(f.out[n][3]), x, y, z);
    const Lanes along = planeOf(f.along[n], zero, x, y, z);
    const Lanes beyond = max(max(all(f.begin[n]) - along, along - all(f.end[n])), zero);
    const Lanes square = fma(out, out, beyond * beyond);
    outermost = n == 0 ? out : max(outermost, out);
    if (n == 0) beyond_longest = beyond;
    least = n == 0 ? square : min(least, square);
  }
  const Lanes height = planeOf(f.normal, all(f.normal[3]), x, y, z);
  // A point within all sides is over the triangle. The longest side is tested as well: without it
  // rounding could put a point beyond a needle's tip inside.
  const Lanes in_plane =
      whereLess(outermost, zero, whereLess(zero, beyond_longest, least, zero), least);
  return fma(height, height, in_plane);
}

/// The centers of the eight parts of a cube.
struct Eight {
  Lanes x, y, z;
};

PALPATE_KERNEL Eight eightAbout(float x, float y, float z, float step) noexcept {
  return {xSigns(step) + all(x), ySigns(step) + all(y), zSigns(step) + all(z)};
}

/// A list of facets for each of the eight parts of a cube, `stride` entries apart.
struct Lists {
  std::uint32_t* lists;
  std::size_t stride;
  std::uint32_t counts[8];
};

/// Selects, of `count` facets, those within reach of each part; `reach` is the part's half
/// diagonal. `from` is the list to select from; nullptr: all facets.
PALPATE_KERNEL void select(const LeafQuery& q, const std::uint32_t* from, std::uint32_t count,
                           const Eight& at, float reach, float* squares, Lists& to) noexcept {
  Lanes least = all(kFarSquare);
  for (std::uint32_t n = 0; n < count; ++n) {
    const Lanes here = squaresOf(q.facets[from == nullptr ? n : from[n]], at.x, at.y, at.z);
    store(here, squares + std::size_t{8} * n);
    least = min(least, here);
  }
  // A hundred-thousandth covers the rounding.
  const Lanes most = all(q.half_width + reach + 1e-4F);
  Lanes limit = min(fma(root(least), all(1.00001F), all(2.0F * reach + 1e-4F)), most);
  limit = whereLess(most * most, least, all(-1.0F), limit * limit);
  for (std::uint32_t& kept : to.counts) kept = 0;
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::uint32_t name = from == nullptr ? n : from[n];
    const std::uint32_t near = atMost(load(squares + std::size_t{8} * n), limit);
    // An entry is written before it is known whether it stays: cheaper than a branch.
    for (std::size_t part = 0; part < 8; ++part) {
      to.lists[part * to.stride + to.counts[part]] = name;
      to.counts[part] += near >> part & 1U;
    }
  }
}

/// Writes the results for the eight voxels of a cube of 2^3 to their places.
PALPATE_KERNEL void scatter(const Lanes& squares, float* corner) noexcept {
  float found[8];
  store(squares, found);
  for (int n = 0; n < 8; ++n) corner[(n >> 2) * 64 + ((n >> 1) & 1) * 8 + (n & 1)] = found[n];
}

PALPATE_ENTRY void searchLeaf(const LeafQuery& q) noexcept {
  constexpr float kReachFour = 2.598077F;  // [voxels] half diagonal of the voxel centers of 4^3
  constexpr float kReachTwo = 0.8660254F;  // and of 2^3
  for (int n = 0; n < 512; ++n) q.squares[n] = kFarSquare;
  Lists nearby{q.nearby, std::size_t{q.count} + 1, {}};
  Lists close{q.close, std::size_t{q.count} + 1, {}};
  select(q, nullptr, q.count, eightAbout(0.0F, 0.0F, 0.0F, 2.0F), kReachFour, q.distances, nearby);
  for (std::size_t four = 0; four < 8; ++four) {
    const std::uint32_t count = nearby.counts[four];
    if (count == 0) continue;
    const std::size_t fx = four >> 2, fy = (four >> 1) & 1, fz = four & 1;
    const float x = 4.0F * static_cast<float>(fx) - 2.0F;
    const float y = 4.0F * static_cast<float>(fy) - 2.0F;
    const float z = 4.0F * static_cast<float>(fz) - 2.0F;
    select(q, nearby.lists + four * nearby.stride, count, eightAbout(x, y, z, 1.0F), kReachTwo,
           q.distances, close);
    for (std::size_t two = 0; two < 8; ++two) {
      if (close.counts[two] == 0) continue;
      const std::uint32_t* const list = close.lists + two * close.stride;
      const std::size_t tx = two >> 2, ty = (two >> 1) & 1, tz = two & 1;
      const Eight at = eightAbout(x + 2.0F * static_cast<float>(tx) - 1.0F,
                                  y + 2.0F * static_cast<float>(ty) - 1.0F,
                                  z + 2.0F * static_cast<float>(tz) - 1.0F, 0.5F);
      Lanes least = all(kFarSquare);
      for (std::uint32_t n = 0; n < close.counts[two]; ++n) {
        least = min(least, squaresOf(q.facets[list[n]], at.x, at.y, at.z));
      }
      scatter(least, q.squares + (4 * fx + 2 * tx) * 64 + (4 * fy + 2 * ty) * 8 + 4 * fz + 2 * tz);
    }
  }
}

}  // namespace
}  // namespace palpate::vdb
