// Compiled for processors with AVX2; called where they are.
#if defined(__x86_64__)

#include "scan/relax.h"
#include "scan/relax_kernel.h"

namespace palpate::vdb {

const RelaxKernels kAvx2RelaxKernels = {forceOf, relaxRows, diffuseRows};

}  // namespace palpate::vdb

#endif
