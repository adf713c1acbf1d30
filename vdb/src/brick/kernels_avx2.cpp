// The kernels for processors with AVX2 and FMA (2013 and later).

#define PALPATE_TARGET "avx2,fma"
#include "brick/kernels_x86.h"

#if defined(__x86_64__)

namespace palpate::vdb {

BrickKernels avx2Kernels() noexcept { return kernels(); }

}  // namespace palpate::vdb

#endif
