// The kernels for every processor.

#include "brick/kernels.h"

namespace palpate::vdb {

BrickKernels baseKernels() noexcept { return kernels(); }

}  // namespace palpate::vdb
