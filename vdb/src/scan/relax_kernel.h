// The inner loops of the smoothing of masks, eight voxels at a time: a kernel, as simd.h says. It
// uses no fused operations, so that every instruction set gives the same bits.

#include "scan/relax.h"
#include "simd.h"

namespace palpate::vdb {
namespace {

inline constexpr std::ptrdiff_t kStepX = std::ptrdiff_t{Patch::kSide} * Patch::kRow;
inline constexpr std::ptrdiff_t kStepY = Patch::kRow;
inline constexpr std::ptrdiff_t kStepZ = 1;

PALPATE_KERNEL const float* rowOf(const Patch& patch, int row) noexcept {
  return patch.values + Patch::kHalo * (kStepX + kStepY) + Patch::kFirst + (row >> 3) * kStepX +
         (row & 7) * kStepY;
}

/// A difference that involves a voxel outside the band is NaN; it counts as 0.
PALPATE_KERNEL Floats known(Floats a) noexcept { return whereLess(a, all(3e38F), a, all(0.0F)); }

/// The second difference along one axis.
PALPATE_KERNEL Floats bend(const float* c, std::ptrdiff_t s) noexcept {
  return known(load(c - s) - 2.0F * load(c) + load(c + s));
}

/// The mixed difference of the square that begins at c.
PALPATE_KERNEL Floats twist(const float* c, std::ptrdiff_t u, std::ptrdiff_t v) noexcept {
  return known(load(c) - load(c + u) - load(c + v) + load(c + u + v));
}

/// For each place along a row, the sum over the squares that a row of voxels shares with its
/// neighbor u away. The force is such a sum minus the one before it.
PALPATE_KERNEL Floats twistAlongRow(const float* c, std::ptrdiff_t u) noexcept {
  return twist(c, u, kStepZ) - twist(c - kStepZ, u, kStepZ);
}

/// Calls take(row, its first voxel, the force on its eight voxels) for each row whose bit in `rows`
/// is set. Differences that adjacent rows share are computed once. Differences that touch a row
/// without voxels are 0, so that nothing is carried across such a row.
template <typename Take>
PALPATE_KERNEL void forForces(const Patch& patch, std::uint64_t rows, const RelaxWeights& w,
                              const Take& take) {
  const Floats none{};
  // For each y: sums of slab x - 1 and of slab x.
  Floats bend_before[8];
  Floats bend_here[8];
  Floats twist_before[8];
  for (int y = 0; y < 8; ++y) {
    bend_before[y] = bend_here[y] = twist_before[y] = none;
    if ((rows >> y & 1U) == 0) continue;
    const float* const c = rowOf(patch, y) - kStepX;
    bend_before[y] = bend(c, kStepX);
    bend_here[y] = bend(c + kStepX, kStepX);
    twist_before[y] = w.plane[2] * (twist(c, kStepX, kStepY) - twist(c - kStepY, kStepX, kStepY)) +
                      w.plane[1] * twistAlongRow(c, kStepX);
  }
  for (int x = 0; x < 8; ++x) {
    // The same for row y - 1 and row y.
    Floats y_bend_before = none;
    Floats y_bend_here = none;
    Floats xy_before = none;
    Floats yz_before = none;
    if ((rows >> (8 * x) & 1U) != 0) {
      const float* const c = rowOf(patch, 8 * x) - kStepY;
      y_bend_before = bend(c, kStepY);
      y_bend_here = bend(c + kStepY, kStepY);
      xy_before = twist(c, kStepX, kStepY);
      yz_before = twistAlongRow(c, kStepY);
    }
    for (int y = 0; y < 8; ++y) {
      const int row = 8 * x + y;
      if ((rows >> row & 1U) == 0) {
        bend_before[y] = bend_here[y] = twist_before[y] = none;
        y_bend_before = y_bend_here = xy_before = yz_before = none;
        continue;
      }
      const float* const c = rowOf(patch, row);
      const Floats bend_next = bend(c + kStepX, kStepX);
      const Floats y_bend_next = bend(c + kStepY, kStepY);
      const Floats z_bends =
          bend(c - kStepZ, kStepZ) - 2.0F * bend(c, kStepZ) + bend(c + kStepZ, kStepZ);
      const Floats xy = twist(c, kStepX, kStepY);
      const Floats yz = twistAlongRow(c, kStepY);
      const Floats twist_here =
          w.plane[2] * (xy - xy_before) + w.plane[1] * twistAlongRow(c, kStepX);
      take(row, c,
           w.axis[0] * (bend_before[y] - 2.0F * bend_here[y] + bend_next) +
               w.axis[1] * (y_bend_before - 2.0F * y_bend_here + y_bend_next) +
               w.axis[2] * z_bends + w.plane[0] * (yz - yz_before) +
               (twist_here - twist_before[y]));
      bend_before[y] = bend_here[y];
      bend_here[y] = bend_next;
      twist_before[y] = twist_here;
      y_bend_before = y_bend_here;
      y_bend_here = y_bend_next;
      xy_before = xy;
      yz_before = yz;
    }
  }
}

/// Stores the force itself.
struct PutForce {
  float* out;

  PALPATE_KERNEL void operator()(int row, const float*, const Floats& force) const noexcept {
    store(force, out + std::ptrdiff_t{8} * row);
  }
};

/// Applies a step of relaxation.
struct Relax {
  const RelaxStep& step;

  PALPATE_KERNEL void operator()(int row, const float* c, const Floats& whole) const noexcept {
    const std::ptrdiff_t n = std::ptrdiff_t{8} * row;
    const Floats force = whole - load(step.bias + n);
    const Floats lower = load(step.lower + n);
    const Floats upper = load(step.upper + n);
    // NaN compares neither less nor greater, and stays.
    Floats value = load(c) - force * load(step.share + n);
    value = whereLess(value, lower, lower, value);
    value = whereLess(upper, value, upper, value);
    const Floats before = load(step.value + n);
    store(value + step.momentum * (value - before), step.ahead + n);
    store(value, step.value + n);
  }
};

PALPATE_ENTRY void forceOf(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                           float* out) {
  forForces(patch, rows, weights, PutForce{out});
}

PALPATE_ENTRY void relaxRows(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                             const RelaxStep& step) {
  forForces(patch, rows, weights, Relax{step});
}

PALPATE_ENTRY void diffuseRows(const Patch& patch, std::uint64_t rows, int stride,
                               const float* share, float* out) {
  for (; rows != 0; rows &= rows - 1) {
    const int row = __builtin_ctzll(rows);
    const float* const c = rowOf(patch, row);
    const Floats here = load(c);
    Floats sum = here;
    for (int a = 0; a < 3; ++a) {
      const std::ptrdiff_t s = stride * (a == 0 ? kStepX : a == 1 ? kStepY : kStepZ);
      sum += share[a] * (known(load(c - s) - here) + known(load(c + s) - here));
    }
    store(sum, out + std::ptrdiff_t{8} * row);
  }
}

}  // namespace
}  // namespace palpate::vdb
