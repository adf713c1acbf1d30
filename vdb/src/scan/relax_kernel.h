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

constexpr std::ptrdiff_t kStepX = Patch::kSide * Patch::kRow;
constexpr std::ptrdiff_t kStepY = Patch::kRow;
constexpr std::ptrdiff_t kStepZ = 1;

inline const float* rowOf(const Patch& patch, int row) noexcept {
  return patch.values + Patch::kHalo * (kStepX + kStepY) + Patch::kFirst + (row >> 3) * kStepX +
         (row & 7) * kStepY;
}

/// NaN, which any voxel outside the band makes of a difference, is no difference.
inline Eight known(Eight a) noexcept {
  const EightBits is = a == a;
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

inline void hessianForceOf(const Patch& patch, std::uint64_t rows, const RelaxWeights& w,
                           float* out) noexcept {
  for (; rows != 0; rows &= rows - 1) {
    const int row = __builtin_ctzll(rows);
    const float* const c = rowOf(patch, row);
    const Eight force = w.axis[0] * alongAxis(c, kStepX) + w.axis[1] * alongAxis(c, kStepY) +
                        w.axis[2] * alongAxis(c, kStepZ) + w.plane[0] * inPlane(c, kStepY, kStepZ) +
                        w.plane[1] * inPlane(c, kStepZ, kStepX) +
                        w.plane[2] * inPlane(c, kStepX, kStepY);
    __builtin_memcpy(out + 8 * row, &force, sizeof force);
  }
}

inline void diffuseOf(const Patch& patch, std::uint64_t rows, int stride, const float* share,
                      float* out) noexcept {
  for (; rows != 0; rows &= rows - 1) {
    const int row = __builtin_ctzll(rows);
    const float* const c = rowOf(patch, row);
    const Eight here = at(c);
    Eight sum = here;
    for (int a = 0; a < 3; ++a) {
      const std::ptrdiff_t s = stride * (a == 0 ? kStepX : a == 1 ? kStepY : kStepZ);
      sum += share[a] * (known(at(c - s) - here) + known(at(c + s) - here));
    }
    __builtin_memcpy(out + 8 * row, &sum, sizeof sum);
  }
}

}  // namespace
}  // namespace palpate::vdb
