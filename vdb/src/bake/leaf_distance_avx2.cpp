// Compiled for processors with AVX2 and FMA; called where they are.
#include "bake/leaf_distance.h"

#if defined(__AVX2__) && defined(__FMA__)

#include <immintrin.h>

namespace palpate::vdb {
namespace {

struct Lanes {
  __m256 v;
  explicit Lanes(__m256 all) : v(all) {}
  explicit Lanes(float each) : v(_mm256_set1_ps(each)) {}
  static Lanes xSigns(float s) { return Lanes(_mm256_setr_ps(-s, -s, -s, -s, s, s, s, s)); }
  static Lanes ySigns(float s) { return Lanes(_mm256_setr_ps(-s, -s, s, s, -s, -s, s, s)); }
  static Lanes zSigns(float s) { return Lanes(_mm256_setr_ps(-s, s, -s, s, -s, s, -s, s)); }
  static float root(float s) { return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(s))); }
  void store(float* to) const { _mm256_storeu_ps(to, v); }
};

inline Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(_mm256_add_ps(a.v, b.v)); }
inline Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(_mm256_sub_ps(a.v, b.v)); }
inline Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(_mm256_mul_ps(a.v, b.v)); }
inline Lanes operator&(const Lanes& a, const Lanes& b) { return Lanes(_mm256_and_ps(a.v, b.v)); }
inline Lanes min(const Lanes& a, const Lanes& b) { return Lanes(_mm256_min_ps(a.v, b.v)); }
inline Lanes max(const Lanes& a, const Lanes& b) { return Lanes(_mm256_max_ps(a.v, b.v)); }
inline Lanes fma(const Lanes& a, const Lanes& b, const Lanes& c) {
  return Lanes(_mm256_fmadd_ps(a.v, b.v, c.v));
}
inline Lanes isNegative(const Lanes& a) {
  return Lanes(_mm256_cmp_ps(a.v, _mm256_setzero_ps(), _CMP_LT_OQ));
}
inline Lanes isZero(const Lanes& a) {
  return Lanes(_mm256_cmp_ps(a.v, _mm256_setzero_ps(), _CMP_EQ_OQ));
}
inline Lanes zeroWhere(const Lanes& mask, const Lanes& a) {
  return Lanes(_mm256_andnot_ps(mask.v, a.v));
}

}  // namespace
}  // namespace palpate::vdb

#include "bake/leaf_distance_kernel.h"

namespace palpate::vdb {

void findSquaresAvx2(const LeafQuery& query) noexcept { searchLeaf<Lanes>(query); }

}  // namespace palpate::vdb

#else

namespace palpate::vdb {

void findSquaresAvx2(const LeafQuery& query) noexcept { findSquaresPlain(query); }

}  // namespace palpate::vdb

#endif
