// Four doubles at a time, for kernels.h. No include guard and no namespace of its own: a kernel's
// translation unit includes it once, after PALPATE_KERNEL says with what attributes to compile.
// Attributes rather than compiler flags, so that no inline function of another header is compiled for
// more than the least processor.

#if !defined(PALPATE_KERNEL)
#error "define PALPATE_KERNEL, and PALPATE_KERNEL_FMA if the target has it"
#endif

using Lanes = double __attribute__((vector_size(32)));

/// a * b + c
PALPATE_KERNEL Lanes fma(Lanes a, Lanes b, Lanes c) noexcept {
#if defined(PALPATE_KERNEL_FMA)
  return _mm256_fmadd_pd(a, b, c);
#else
  return a * b + c;
#endif
}

/// c - a * b
PALPATE_KERNEL Lanes fnma(Lanes a, Lanes b, Lanes c) noexcept {
#if defined(PALPATE_KERNEL_FMA)
  return _mm256_fnmadd_pd(a, b, c);
#else
  return c - a * b;
#endif
}

/// a * b + c
PALPATE_KERNEL double fma(double a, double b, double c) noexcept {
#if defined(PALPATE_KERNEL_FMA)
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}

PALPATE_KERNEL Lanes all(double a) noexcept { return Lanes{a, a, a, a}; }

/// The same, where much is made of it: on all lanes at once. The compiler would reckon with one lane
/// and copy each of the results.
PALPATE_KERNEL Lanes allOnce(double a) noexcept {
  Lanes lanes = all(a);
#if defined(PALPATE_KERNEL_FMA)
  asm("" : "+x"(lanes));
#endif
  return lanes;
}

/// Four floats from anywhere.
PALPATE_KERNEL Lanes load(const float* from) noexcept {
#if defined(PALPATE_KERNEL_FMA)
  return _mm256_cvtps_pd(_mm_loadu_ps(from));
#else
  return Lanes{from[0], from[1], from[2], from[3]};
#endif
}

/// The sums of a, of b, of c and of d.
PALPATE_KERNEL Lanes sums(Lanes a, Lanes b, Lanes c, Lanes d) noexcept {
#if defined(PALPATE_KERNEL_FMA)
  const Lanes ab = Lanes(_mm256_unpacklo_pd(a, b)) + Lanes(_mm256_unpackhi_pd(a, b));
  const Lanes cd = Lanes(_mm256_unpacklo_pd(c, d)) + Lanes(_mm256_unpackhi_pd(c, d));
  return _mm256_permute2f128_pd(ab, cd, 0x21) + _mm256_blend_pd(ab, cd, 0b1100);
#else
  return Lanes{(a[0] + a[1]) + (a[2] + a[3]), (b[0] + b[1]) + (b[2] + b[3]),
               (c[0] + c[1]) + (c[2] + c[3]), (d[0] + d[1]) + (d[2] + d[3])};
#endif
}
