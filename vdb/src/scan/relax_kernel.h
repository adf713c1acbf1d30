// The inner loop of the smoothing of masks, eight voxels at a time. No include guard: the two files
// that compile it, for different processors, include it once each. No fused operations, so that both give
// the same bits.

#include "scan/relax.h"

namespace palpate::vdb {
namespace {

using Eight = float __attribute__((vector_size(32)));
using EightBits = std::int32_t __attribute__((vector_size(32)));

inline Eight at(const float* from) noexcept {
  Eight result;
  __builtin_memcpy(&result, from, sizeof result);
  return result;
}

inline constexpr std::ptrdiff_t kStepX = std::ptrdiff_t{Patch::kSide} * Patch::kRow;
inline constexpr std::ptrdiff_t kStepY = Patch::kRow;
inline constexpr std::ptrdiff_t kStepZ = 1;

inline const float* rowOf(const Patch& patch, int row) noexcept {
  return patch.values + Patch::kHalo * (kStepX + kStepY) + Patch::kFirst + (row >> 3) * kStepX +
         (row & 7) * kStepY;
}

/// NaN, which any voxel outside the band makes of a difference, is no difference.
inline Eight known(Eight a) noexcept {
  const EightBits is = a < Eight{} + 3e38F;  // false for NaN
  EightBits bits;
  __builtin_memcpy(&bits, &a, sizeof bits);
  bits &= is;
  __builtin_memcpy(&a, &bits, sizeof a);
  return a;
}

/// The second difference along one axis.
inline Eight bend(const float* c, std::ptrdiff_t s) noexcept {
  return known(at(c - s) - 2.0F * at(c) + at(c + s));
}

/// The mixed difference of the square from c on.
inline Eight twist(const float* c, std::ptrdiff_t u, std::ptrdiff_t v) noexcept {
  return known(at(c) - at(c + u) - at(c + v) + at(c + u + v));
}

/// The sum over the squares that share a row of voxels and its neighbor u away, by their places along the row: what
/// the later of two such sums has more than the one before it is the force.
inline Eight twistAlongRow(const float* c, std::ptrdiff_t u) noexcept {
  return twist(c, u, kStepZ) - twist(c - kStepZ, u, kStepZ);
}

inline void put(const Eight& a, float* to) noexcept { __builtin_memcpy(to, &a, sizeof a); }

/// take(row, its first voxel, the force on its eight voxels) for each row that `rows` has a bit for. Differences that
/// rows side by side share are worked out once. Those that touch a row without voxels are none, so nothing is
/// carried across one.
template <typename Take>
inline void forForces(const Patch& patch, std::uint64_t rows, const RelaxWeights& w,
                      const Take& take) {
  const Eight none{};
  // For each y, of the slabs x before and here.
  Eight bend_before[8];
  Eight bend_here[8];
  Eight twist_before[8];
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
    // The same of the rows y before and here.
    Eight y_bend_before = none;
    Eight y_bend_here = none;
    Eight xy_before = none;
    Eight yz_before = none;
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
      const Eight bend_next = bend(c + kStepX, kStepX);
      const Eight y_bend_next = bend(c + kStepY, kStepY);
      const Eight z_bends =
          bend(c - kStepZ, kStepZ) - 2.0F * bend(c, kStepZ) + bend(c + kStepZ, kStepZ);
      const Eight xy = twist(c, kStepX, kStepY);
      const Eight yz = twistAlongRow(c, kStepY);
      const Eight twist_here =
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

inline void forceOf(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                    float* out) {
  forForces(patch, rows, weights, [&](int row, const float*, const Eight& force) {
    put(force, out + std::ptrdiff_t{8} * row);
  });
}

inline void relaxRows(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                      const RelaxStep& step) {
  forForces(patch, rows, weights, [&](int row, const float* c, const Eight& whole) {
    const std::ptrdiff_t n = std::ptrdiff_t{8} * row;
    const Eight force = whole - at(step.bias + n);
    const Eight lower = at(step.lower + n);
    const Eight upper = at(step.upper + n);
    // NaN is neither less nor more, and stays.
    Eight value = at(c) - force * at(step.share + n);
    value = value < lower ? lower : value;
    value = value > upper ? upper : value;
    const Eight before = at(step.value + n);
    put(value + step.momentum * (value - before), step.ahead + n);
    put(value, step.value + n);
  });
}

inline void diffuseRows(const Patch& patch, std::uint64_t rows, int stride, const float* share,
                        float* out) {
  for (; rows != 0; rows &= rows - 1) {
    const int row = __builtin_ctzll(rows);
    const float* const c = rowOf(patch, row);
    const Eight here = at(c);
    Eight sum = here;
    for (int a = 0; a < 3; ++a) {
      const std::ptrdiff_t s = stride * (a == 0 ? kStepX : a == 1 ? kStepY : kStepZ);
      sum += share[a] * (known(at(c - s) - here) + known(at(c + s) - here));
    }
    put(sum, out + std::ptrdiff_t{8} * row);
  }
}

}  // namespace
}  // namespace palpate::vdb
