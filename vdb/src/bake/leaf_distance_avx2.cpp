// The variant of the search for processors with AVX2 and FMA.

#if defined(__x86_64__)

#define PALPATE_TARGET "avx2,fma"
#include "bake/leaf_distance_kernel.h"

namespace palpate::vdb {

void findSquaresAvx2(const LeafQuery& query) noexcept { searchLeaf(query); }

}  // namespace palpate::vdb

#endif
