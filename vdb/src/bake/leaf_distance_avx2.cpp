// The search for processors with AVX2 and FMA; called where they are.
#include "bake/leaf_distance.h"

#if defined(__x86_64__)

#include <immintrin.h>

#define PALPATE_KERNEL [[gnu::target("avx2,fma"), gnu::always_inline]] inline

namespace palpate::vdb {
namespace {

using Lanes = __m256;

PALPATE_KERNEL Lanes all(float each) noexcept { return _mm256_set1_ps(each); }
PALPATE_KERNEL Lanes xSigns(float s) noexcept { return _mm256_setr_ps(-s, -s, -s, -s, s, s, s, s); }
PALPATE_KERNEL Lanes ySigns(float s) noexcept { return _mm256_setr_ps(-s, -s, s, s, -s, -s, s, s); }
PALPATE_KERNEL Lanes zSigns(float s) noexcept { return _mm256_setr_ps(-s, s, -s, s, -s, s, -s, s); }
PALPATE_KERNEL Lanes load(const float* from) noexcept { return _mm256_loadu_ps(from); }
PALPATE_KERNEL void store(Lanes a, float* to) noexcept { _mm256_storeu_ps(to, a); }
PALPATE_KERNEL Lanes min(Lanes a, Lanes b) noexcept { return _mm256_min_ps(a, b); }
PALPATE_KERNEL Lanes max(Lanes a, Lanes b) noexcept { return _mm256_max_ps(a, b); }
PALPATE_KERNEL Lanes root(Lanes a) noexcept { return _mm256_sqrt_ps(a); }
PALPATE_KERNEL Lanes fma(Lanes a, Lanes b, Lanes c) noexcept { return _mm256_fmadd_ps(a, b, c); }

/// 0 where `outermost` is negative and `beyond` 0, else `otherwise`.
PALPATE_KERNEL Lanes zeroWhereInside(Lanes outermost, Lanes beyond, Lanes otherwise) noexcept {
  const Lanes zero = _mm256_setzero_ps();
  const Lanes inside = _mm256_and_ps(_mm256_cmp_ps(outermost, zero, _CMP_LT_OQ),
                                     _mm256_cmp_ps(beyond, zero, _CMP_EQ_OQ));
  return _mm256_andnot_ps(inside, otherwise);
}

/// -1 where a > b, else `otherwise`.
PALPATE_KERNEL Lanes noneWhereAbove(Lanes a, Lanes b, Lanes otherwise) noexcept {
  return _mm256_blendv_ps(otherwise, _mm256_set1_ps(-1.0F), _mm256_cmp_ps(a, b, _CMP_GT_OQ));
}

/// A bit for each lane where a <= b.
PALPATE_KERNEL std::uint32_t atMost(Lanes a, Lanes b) noexcept {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
}

#include "bake/leaf_distance_kernel.h"

}  // namespace

[[gnu::target("avx2,fma")]] void findSquaresAvx2(const LeafQuery& query) noexcept {
  searchLeaf(query);
}

}  // namespace palpate::vdb

#else

namespace palpate::vdb {

void findSquaresAvx2(const LeafQuery& query) noexcept { findSquaresPlain(query); }

}  // namespace palpate::vdb

#endif
