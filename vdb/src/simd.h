// Operations on four doubles or eight floats at a time, for kernels. No include guard: a kernel is
// a translation unit for one instruction set. It defines PALPATE_TARGET as that set and includes
// this file once; without PALPATE_TARGET it is compiled for every processor.
//   PALPATE_KERNEL  before every function of a kernel
//   PALPATE_ENTRY   before those that are called from elsewhere
// Attributes rather than compiler flags, so that no inline function of another header is compiled
// for more than the baseline processor. Only the operations that say so are fused: all others give
// the same bits for every instruction set.

#include <cstdint>

#if defined(PALPATE_TARGET)
#include <immintrin.h>
#define PALPATE_KERNEL [[gnu::always_inline, gnu::target(PALPATE_TARGET)]] inline
#define PALPATE_ENTRY [[gnu::target(PALPATE_TARGET)]] inline
#else
#define PALPATE_KERNEL [[gnu::always_inline]] inline
#define PALPATE_ENTRY inline
#endif

namespace palpate::vdb {
namespace {

using Doubles = double __attribute__((vector_size(32)));
using Floats = float __attribute__((vector_size(32)));

/// a * b + c, fused where the instruction set has it.
PALPATE_KERNEL Doubles fma(Doubles a, Doubles b, Doubles c) noexcept {
#if defined(PALPATE_TARGET)
  return _mm256_fmadd_pd(a, b, c);
#else
  return a * b + c;
#endif
}
PALPATE_KERNEL Floats fma(Floats a, Floats b, Floats c) noexcept {
#if defined(PALPATE_TARGET)
  return _mm256_fmadd_ps(a, b, c);
#else
  return a * b + c;
#endif
}
PALPATE_KERNEL double fma(double a, double b, double c) noexcept {
#if defined(PALPATE_TARGET)
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}

/// c - a * b, fused where the instruction set has it.
PALPATE_KERNEL Doubles fnma(Doubles a, Doubles b, Doubles c) noexcept {
#if defined(PALPATE_TARGET)
  return _mm256_fnmadd_pd(a, b, c);
#else
  return c - a * b;
#endif
}

PALPATE_KERNEL Doubles all(double a) noexcept { return Doubles{a, a, a, a}; }
PALPATE_KERNEL Floats all(float a) noexcept { return Floats{a, a, a, a, a, a, a, a}; }

/// The same, for a value that many results are computed from. Otherwise the compiler would compute
/// with one lane and copy each result.
PALPATE_KERNEL Doubles allOnce(double a) noexcept {
  Doubles lanes = all(a);
#if defined(PALPATE_TARGET)
  asm("" : "+x"(lanes));
#endif
  return lanes;
}

/// Loads eight floats, at any alignment.
PALPATE_KERNEL Floats load(const float* from) noexcept {
  Floats lanes;
  __builtin_memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
PALPATE_KERNEL void store(Floats a, float* to) noexcept { __builtin_memcpy(to, &a, sizeof a); }

/// Loads four floats, at any alignment, as doubles.
PALPATE_KERNEL Doubles loadWidened(const float* from) noexcept {
#if defined(PALPATE_TARGET)
  return _mm256_cvtps_pd(_mm_loadu_ps(from));
#else
  return Doubles{from[0], from[1], from[2], from[3]};
#endif
}

/// Four sums: that of the lanes of a, of b, of c and of d.
PALPATE_KERNEL Doubles sums(Doubles a, Doubles b, Doubles c, Doubles d) noexcept {
#if defined(PALPATE_TARGET)
  const Doubles ab = Doubles(_mm256_unpacklo_pd(a, b)) + Doubles(_mm256_unpackhi_pd(a, b));
  const Doubles cd = Doubles(_mm256_unpacklo_pd(c, d)) + Doubles(_mm256_unpackhi_pd(c, d));
  return _mm256_permute2f128_pd(ab, cd, 0x21) + _mm256_blend_pd(ab, cd, 0b1100);
#else
  return Doubles{(a[0] + a[1]) + (a[2] + a[3]), (b[0] + b[1]) + (b[2] + b[3]),
                 (c[0] + c[1]) + (c[2] + c[3]), (d[0] + d[1]) + (d[2] + d[3])};
#endif
}

/// `yes` where a < b, else `no`; a NaN gives `no`.
PALPATE_KERNEL Floats whereLess(Floats a, Floats b, Floats yes, Floats no) noexcept {
#if defined(PALPATE_TARGET)
  return a < b ? yes : no;
#else
  // In halves, which every processor compares at once; for whole vectors the compiler would go lane
  // by lane.
  using Four = float __attribute__((vector_size(16)));
  Four halves[4][2];
  const Floats wholes[4] = {a, b, yes, no};
  __builtin_memcpy(halves, wholes, sizeof halves);
  for (int n = 0; n < 2; ++n) {
    halves[3][n] = halves[0][n] < halves[1][n] ? halves[2][n] : halves[3][n];
  }
  Floats result;
  __builtin_memcpy(&result, halves[3], sizeof result);
  return result;
#endif
}

/// If one of them is NaN, the result is b.
PALPATE_KERNEL Floats min(Floats a, Floats b) noexcept {
#if defined(PALPATE_TARGET)
  return _mm256_min_ps(a, b);
#else
  return whereLess(a, b, a, b);
#endif
}
PALPATE_KERNEL Floats max(Floats a, Floats b) noexcept {
#if defined(PALPATE_TARGET)
  return _mm256_max_ps(a, b);
#else
  return whereLess(b, a, a, b);
#endif
}

PALPATE_KERNEL Floats root(Floats a) noexcept {
#if defined(PALPATE_TARGET)
  return _mm256_sqrt_ps(a);
#else
  for (int n = 0; n < 8; ++n) a[n] = __builtin_sqrtf(a[n]);
  return a;
#endif
}

/// A bit for each lane: whether a <= b.
PALPATE_KERNEL std::uint32_t atMost(Floats a, Floats b) noexcept {
#if defined(PALPATE_TARGET)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
#else
  std::uint32_t bits = 0;
  for (int n = 0; n < 8; ++n) bits |= (a[n] <= b[n] ? 1U : 0U) << n;
  return bits;
#endif
}

}  // namespace
}  // namespace palpate::vdb
