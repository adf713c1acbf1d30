// The kernels for processors with AVX2 and FMA (2013 and later).

#if defined(__x86_64__)

#define PALPATE_TARGET "avx2,fma"
#include "brick/kernels.h"

namespace palpate::vdb {

BrickKernels avx2Kernels() noexcept { return kernels(); }

}  // namespace palpate::vdb

#endif
