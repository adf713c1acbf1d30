// The kernels for every processor.

#include <bit>

#include "brick/instruction_set.h"

namespace palpate::vdb {
namespace {

#define PALPATE_KERNEL [[gnu::always_inline]] inline
#define PALPATE_ENTRY inline
#include "brick/simd.h"
// simd.h comes first
#include "brick/kernels.h"

}  // namespace

BrickKernels baseKernels() noexcept { return kernels(); }

}  // namespace palpate::vdb
