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

inline Eight alongAxis(const float* c, std::ptrdiff_t s) noexcept {
  return bend(c - s, s) - 2.0F * bend(c, s) + bend(c + s, s);
}

inline Eight inPlane(const float* c, std::ptrdiff_t u, std::ptrdiff_t v) noexcept {
  return twist(c, u, v) - twist(c - u, u, v) - twist(c - v, u, v) + twist(c - u - v, u, v);
}

inline Eight forceAt(const float* c, const RelaxWeights& w) noexcept {
  return w.axis[0] * alongAxis(c, kStepX) + w.axis[1] * alongAxis(c, kStepY) +
         w.axis[2] * alongAxis(c, kStepZ) + w.plane[0] * inPlane(c, kStepY, kStepZ) +
         w.plane[1] * inPlane(c, kStepZ, kStepX) + w.plane[2] * inPlane(c, kStepX, kStepY);
}

inline void put(const Eight& a, float* to) noexcept { __builtin_memcpy(to, &a, sizeof a); }

inline void forceOf(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                    float* out) {
  for (; rows != 0; rows &= rows - 1) {
    const int row = __builtin_ctzll(rows);
    put(forceAt(rowOf(patch, row), weights), out + std::ptrdiff_t{8} * row);
  }
}

inline void relaxRows(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                      const RelaxStep& step) {
  for (; rows != 0; rows &= rows - 1) {
    const int row = __builtin_ctzll(rows);
    const std::ptrdiff_t n = std::ptrdiff_t{8} * row;
    const float* const c = rowOf(patch, row);
    const Eight force = forceAt(c, weights) - at(step.bias + n);
    const Eight lower = at(step.lower + n);
    const Eight upper = at(step.upper + n);
    // NaN is neither less nor more, and stays.
    Eight value = at(c) - force * at(step.share + n);
    value = value < lower ? lower : value;
    value = value > upper ? upper : value;
    const Eight before = at(step.value + n);
    put(value + step.momentum * (value - before), step.ahead + n);
    put(value, step.value + n);
  }
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
