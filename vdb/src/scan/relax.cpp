#include "scan/relax.h"

#include "brick/instruction_set.h"
#include "scan/relax_kernel.h"

namespace palpate::vdb {

const RelaxKernels kBaseRelaxKernels = {forceOf, relaxRows, diffuseRows};

const RelaxKernels& relaxKernels() noexcept {
#if defined(__x86_64__)
  static const bool has_avx2 = isSupported(InstructionSet::kAvx2);
  if (has_avx2) return kAvx2RelaxKernels;
#endif
  return kBaseRelaxKernels;
}

}  // namespace palpate::vdb
