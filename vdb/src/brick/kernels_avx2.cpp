// The kernels for x86-64 processors with AVX2 and FMA (2013 and later).

#include "brick/instruction_set.h"

#if defined(__x86_64__)

#include <immintrin.h>

namespace palpate::vdb {
namespace {

#define PALPATE_KERNEL [[gnu::always_inline, gnu::target("avx2,fma")]] inline
#define PALPATE_KERNEL_FMA
#define PALPATE_ENTRY [[gnu::target("avx2,fma")]]
#include "brick/simd.h"
// simd.h comes first
#include "brick/kernels.h"

}  // namespace

BrickKernels avx2Kernels() noexcept { return {&sampleCubic, &jetCubic, &sampleLinear}; }

}  // namespace palpate::vdb

#endif
