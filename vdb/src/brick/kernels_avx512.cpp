// The kernels for processors with AVX-512 F and VL: four lanes as with AVX2, with twice as many
// registers.

#if defined(__x86_64__)

#define PALPATE_TARGET "avx2,fma,avx512f,avx512vl"
#include "brick/kernels.h"

namespace palpate::vdb {

BrickKernels avx512Kernels() noexcept { return kernels(); }

}  // namespace palpate::vdb

#endif
