// The loops for processors with AVX2.

#if defined(__x86_64__)

#define PALPATE_TARGET "avx2,fma"
#include "scan/relax_kernel.h"

namespace palpate::vdb {

const RelaxKernels kAvx2RelaxKernels = {forceOf, relaxRows, diffuseRows};

}  // namespace palpate::vdb

#endif
