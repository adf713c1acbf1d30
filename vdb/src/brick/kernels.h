// A query of bricks: a kernel, as simd.h says.
//
// The cubic kernel: with c the 4^3 coefficients around the point and w, d, e the weights of the
// cubic B-spline, its first and its second derivative along one axis,
//   value = sum wx wy wz c,  d/dx = sum dx wy wz c,  d2/dxdy = sum dx dy wz c,  ...
// Sums run over y first, then x, each on four lanes along z; then over the lanes.
//
// The time is limited by how many instructions the processor can look ahead, so that the next query
// starts while this one waits for memory: fewer instructions matter more than shorter dependency
// chains.

#include <bit>

#include "brick/instruction_set.h"
#include "simd.h"

namespace palpate::vdb {
namespace {

using Lanes = Doubles;

/// Where a point lies. Along each axis: the voxel before it (from 0 in the box; a number beyond
/// every box if the point is outside), and its distance from the middle of the cell that begins
/// there, from -0.5 to 0.5.
struct Cell {
  std::uint64_t i, j, k;
  double ux, uy, uz;
};

/// 1.5 * 2^52: a double plus this has its nearest integer in the last bits. For a NaN, an infinite
/// or a negative number, the bits of the sum less those of this constant are beyond every box.
inline constexpr double kRounder = 0x1.8p52;
inline constexpr auto kRounderBits = std::bit_cast<std::uint64_t>(kRounder);

PALPATE_KERNEL Cell locate(const BrickView& view, const Vec3& p) noexcept {
  const double x = fma(p.x, view.per_voxel, view.shift.x);
  const double y = fma(p.y, view.per_voxel, view.shift.y);
  const double z = fma(p.z, view.per_voxel, view.shift.z);
  const double i = x + kRounder;
  const double j = y + kRounder;
  const double k = z + kRounder;
  return {std::bit_cast<std::uint64_t>(i) - kRounderBits,
          std::bit_cast<std::uint64_t>(j) - kRounderBits,
          std::bit_cast<std::uint64_t>(k) - kRounderBits,
          x - (i - kRounder),
          y - (j - kRounder),
          z - (k - kRounder)};
}

/// The brick that holds the cell, or kBeyond, kInside, kOutside.
PALPATE_KERNEL std::uint32_t entryAt(const BrickView& view, const Cell& cell) noexcept {
  if (cell.i >= view.size[0]) [[unlikely]]
    return BrickView::kBeyond;
  if (cell.j >= view.size[1]) [[unlikely]]
    return BrickView::kBeyond;
  if (cell.k >= view.size[2]) [[unlikely]]
    return BrickView::kBeyond;
  const std::uint64_t bx = cell.i >> 3;
  const std::uint64_t by = cell.j >> 3;
  const std::uint64_t bz = cell.k >> 3;
  if (view.coarse == nullptr) [[likely]]
    return view.blocks[bx * view.stride_x + by * view.stride_y + bz];
  const std::uint32_t group =
      view.coarse[(bx >> 3) * view.stride_x + (by >> 3) * view.stride_y + (bz >> 3)];
  if (group >= BrickView::kInside) return group;
  return view
      .blocks[static_cast<std::size_t>(group) * 512 + ((bx & 7) << 6 | (by & 7) << 3 | (bz & 7))];
}

PALPATE_KERNEL const Brick& brickAt(const BrickView& view, std::uint32_t entry) noexcept {
  return *reinterpret_cast<const Brick*>(view.bricks +
                                         static_cast<std::size_t>(entry) * BrickView::kUnit);
}

/// The first value of the cell's stencil, which begins one voxel before the cell along each axis.
PALPATE_KERNEL const float* firstOf(const Brick& brick, const Cell& cell) noexcept {
  const auto x = static_cast<std::uint32_t>(cell.i) & 7U;
  const auto y = static_cast<std::uint32_t>(cell.j) & 7U;
  const auto z = static_cast<std::uint32_t>(cell.k) & 7U;
  return brick.values + (x * Brick::kSlab + y * Brick::kRow + z);
}

PALPATE_KERNEL bool isKnown(const Brick& brick, const Cell& cell) noexcept {
  return (brick.known[(cell.i & 7) * 8 + (cell.j & 7)] >> (cell.k & 7) & 1U) != 0;
}

/// Weights of the four coefficients along one axis, with a the distance from the cell's end and b
/// that from its beginning: a3, w1, w2, b3 give 6 times the value; -a2, d1, -d2, b2 give 2 times
/// the first derivative; and a, 3b - 2, 3a - 2, b the second derivative.
struct Weights {
  Lanes a, b, a2, b2, a3, b3, w1, w2, d1, d2;
};

PALPATE_KERNEL Weights weightsAt(double u) noexcept {
  const Lanes at = allOnce(u);
  Weights w;
  w.a = 0.5 - at;
  w.b = 0.5 + at;
  w.a2 = w.a * w.a;
  w.b2 = w.b * w.b;
  w.a3 = w.a2 * w.a;
  w.b3 = w.b2 * w.b;
  w.w1 = fma(w.b2, fma(all(3.0), w.b, all(-6.0)), all(4.0));
  w.w2 = fma(w.a2, fma(all(3.0), w.a, all(-6.0)), all(4.0));
  w.d1 = w.b * fma(all(3.0), w.b, all(-4.0));
  w.d2 = w.a * fma(all(3.0), w.a, all(-4.0));
  return w;
}

/// The weights of the lanes along z, for the value and for its first and second derivative. All
/// contain the factor 1/6 of the sums along x and y, so that the sum for a value needs no further
/// factor.
struct LaneWeights {
  Lanes value, slope, bend;
};

PALPATE_KERNEL LaneWeights laneWeightsAt(double u) noexcept {
  const Lanes at = allOnce(u);
  constexpr double kShare = 1.0 / 216.0;
  constexpr Lanes kCube = kShare * Lanes{-1.0, 3.0, -3.0, 1.0};
  constexpr Lanes kSquare = kShare * Lanes{1.5, -1.5, -1.5, 1.5};
  constexpr Lanes kLinear = kShare * Lanes{-0.75, -3.75, 3.75, 0.75};
  constexpr Lanes kMiddle = kShare * Lanes{0.125, 2.875, 2.875, 0.125};
  return {fma(fma(fma(kCube, at, kSquare), at, kLinear), at, kMiddle),
          fma(fma(3.0 * kCube, at, 2.0 * kSquare), at, kLinear),
          fma(6.0 * kCube, at, 2.0 * kSquare)};
}

struct Rows {
  Lanes r0, r1, r2, r3;
};

PALPATE_KERNEL Rows rowsAt(const float* row) noexcept {
  return {loadWidened(row), loadWidened(row + Brick::kRow), loadWidened(row + 2 * Brick::kRow),
          loadWidened(row + 3 * Brick::kRow)};
}

/// 6 times the value. As one chain, which takes fewer instructions than two chains in parallel.
PALPATE_KERNEL Lanes valueOf(const Weights& w, const Rows& r) noexcept {
  return fma(w.b3, r.r3, fma(w.w2, r.r2, fma(w.w1, r.r1, w.a3 * r.r0)));
}

/// 2 times the first derivative.
PALPATE_KERNEL Lanes slopeOf(const Weights& w, const Rows& r) noexcept {
  return fma(w.b2, r.r3, fnma(w.d2, r.r2, fnma(w.a2, r.r0, w.d1 * r.r1)));
}

/// The second derivative.
PALPATE_KERNEL Lanes bendOf(const Weights& w, const Rows& r) noexcept {
  const Lanes e1 = fma(all(3.0), w.b, all(-2.0));
  const Lanes e2 = fma(all(3.0), w.a, all(-2.0));
  return fma(e1, r.r1, w.a * r.r0) + fma(w.b, r.r3, e2 * r.r2);
}

/// A slab of the stencil, summed over y.
struct Slab {
  Lanes value, slope, bend;
};

template <bool kWithBend>
PALPATE_KERNEL Slab sumSlab(const float* first, const Weights& y) noexcept {
  const Rows rows = rowsAt(first);
  Lanes bend{};
  if constexpr (kWithBend) bend = bendOf(y, rows);
  return {valueOf(y, rows), slopeOf(y, rows), bend};
}

/// The four slabs along x.
struct Slabs {
  Rows value, slope, bend;
};

template <bool kWithBend>
PALPATE_KERNEL Slabs sumSlabs(const float* first, const Weights& y) noexcept {
  const Slab s0 = sumSlab<kWithBend>(first, y);
  const Slab s1 = sumSlab<kWithBend>(first + Brick::kSlab, y);
  const Slab s2 = sumSlab<kWithBend>(first + 2 * Brick::kSlab, y);
  const Slab s3 = sumSlab<kWithBend>(first + 3 * Brick::kSlab, y);
  return {{s0.value, s1.value, s2.value, s3.value},
          {s0.slope, s1.slope, s2.slope, s3.slope},
          {s0.bend, s1.bend, s2.bend, s3.bend}};
}

/// The sums over a cell's stencil that make value and gradient, and the further ones that make the
/// Hessian.
struct Sums {
  Weights x;
  LaneWeights z;
  Slabs slabs;
  Lanes s, sx, sy;
  Lanes first;  ///< [m] the value, then the gradient
};

template <bool kWithBend>
PALPATE_KERNEL Sums sumsAt(const BrickView& view, const Brick& brick, const Cell& cell) noexcept {
  Sums sum;
  sum.x = weightsAt(cell.ux);
  const Weights y = weightsAt(cell.uy);
  sum.z = laneWeightsAt(cell.uz);
  sum.slabs = sumSlabs<kWithBend>(firstOf(brick, cell), y);
  sum.s = valueOf(sum.x, sum.slabs.value);
  sum.sx = slopeOf(sum.x, sum.slabs.value);
  sum.sy = valueOf(sum.x, sum.slabs.slope);
  sum.first =
      sums(sum.s * sum.z.value, sum.sx * sum.z.value, sum.sy * sum.z.value, sum.s * sum.z.slope) *
      Lanes{view.voxel, 3.0, 3.0, 1.0};
  return sum;
}

PALPATE_ENTRY FieldSample sampleCubic(const BrickView& view, const Vec3& p) noexcept {
  const Cell cell = locate(view, p);
  const std::uint32_t entry = entryAt(view, cell);
  if (entry >= BrickView::kBeyond) [[unlikely]]
    return sampleWithoutBrick(view, entry, p);
  const Brick& brick = brickAt(view, entry);
  const Lanes first = sumsAt<false>(view, brick, cell).first;
  if (!isKnown(brick, cell)) [[unlikely]]
    return {first[0], Vec3(0.0), false};
  return {first[0], Vec3(first[1], first[2], first[3]), true};
}

PALPATE_ENTRY FieldJet jetCubic(const BrickView& view, const Vec3& p) noexcept {
  const Cell cell = locate(view, p);
  const std::uint32_t entry = entryAt(view, cell);
  if (entry >= BrickView::kBeyond) [[unlikely]] {
    const FieldSample sample = sampleWithoutBrick(view, entry, p);
    return {sample.value, sample.gradient, Mat3(0.0), false};
  }
  const Brick& brick = brickAt(view, entry);
  const Sums sum = sumsAt<true>(view, brick, cell);
  const Lanes first = sum.first;
  if (!isKnown(brick, cell)) [[unlikely]]
    return {first[0], Vec3(0.0), Mat3(0.0), false};
  const double scale = view.per_voxel;
  const Lanes second =
      sums(bendOf(sum.x, sum.slabs.value) * sum.z.value,
           valueOf(sum.x, sum.slabs.bend) * sum.z.value, sum.s * sum.z.bend, sum.sy * sum.z.slope) *
      (scale * Lanes{6.0, 6.0, 1.0, 3.0});
  const Lanes mixed = sums(slopeOf(sum.x, sum.slabs.slope) * sum.z.value, sum.sx * sum.z.slope,
                           all(0.0), all(0.0)) *
                      (scale * Lanes{9.0, 3.0, 0.0, 0.0});
  const double xy = mixed[0];
  const double xz = mixed[1];
  const double yz = second[3];
  return {first[0], Vec3(first[1], first[2], first[3]),
          Mat3(second[0], xy, xz, xy, second[1], yz, xz, yz, second[2]), true};
}

/// Trilinear interpolation, from bricks that hold the grid's own values.
PALPATE_ENTRY FieldSample sampleLinear(const BrickView& view, const Vec3& p) noexcept {
  const Cell cell = locate(view, p);
  const std::uint32_t entry = entryAt(view, cell);
  if (entry >= BrickView::kBeyond) [[unlikely]]
    return sampleWithoutBrick(view, entry, p);
  const Brick& brick = brickAt(view, entry);
  const float* const near = firstOf(brick, cell) + Brick::at(0, 0, 0);
  const double tx = cell.ux + 0.5;
  const double ty = cell.uy + 0.5;
  const double tz = cell.uz + 0.5;
  const float* const far = near + Brick::kSlab;
  // The lanes are the four edges along z. Interpolate along z, then y, then x; each step keeps the
  // differences.
  const Lanes low{near[0], near[Brick::kRow], far[0], far[Brick::kRow]};
  const Lanes high{near[1], near[Brick::kRow + 1], far[1], far[Brick::kRow + 1]};
  const Lanes dz = high - low;
  const Lanes v = fma(all(tz), dz, low);
  const double near_y = v[1] - v[0];
  const double far_y = v[3] - v[2];
  const double near_v = v[0] + ty * near_y;
  const double far_v = v[2] + ty * far_y;
  const double dx = far_v - near_v;
  const double distance = (near_v + tx * dx) * view.voxel;
  if (!isKnown(brick, cell)) [[unlikely]]
    return {distance, Vec3(0.0), false};
  const double near_z = dz[0] + ty * (dz[1] - dz[0]);
  const double far_z = dz[2] + ty * (dz[3] - dz[2]);
  return {distance, Vec3(dx, near_y + tx * (far_y - near_y), near_z + tx * (far_z - near_z)), true};
}

inline BrickKernels kernels() noexcept { return {&sampleCubic, &jetCubic, &sampleLinear}; }

}  // namespace
}  // namespace palpate::vdb
