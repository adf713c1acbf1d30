// kernels() for one of x86-64's instruction sets. No include guard: a translation unit includes this once,
// after PALPATE_TARGET names the instructions.

#include "brick/instruction_set.h"

#if defined(__x86_64__)

#include <immintrin.h>

#include <bit>

namespace palpate::vdb {
namespace {

#define PALPATE_KERNEL [[gnu::always_inline, gnu::target(PALPATE_TARGET)]] inline
#define PALPATE_KERNEL_FMA
#define PALPATE_ENTRY [[gnu::target(PALPATE_TARGET)]] inline
#include "brick/simd.h"
// simd.h comes first
#include "brick/kernels.h"

}  // namespace

}  // namespace palpate::vdb

#endif
