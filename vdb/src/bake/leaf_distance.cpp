#include "bake/leaf_distance.h"

#include "bake/leaf_distance_kernel.h"
#include "brick/instruction_set.h"

namespace palpate::vdb {

void findSquaresBase(const LeafQuery& query) noexcept { searchLeaf(query); }

void findSquares(const LeafQuery& query) noexcept {
#if defined(__x86_64__)
  static const bool has_avx2 = isSupported(InstructionSet::kAvx2);
  if (has_avx2) return findSquaresAvx2(query);
#endif
  findSquaresBase(query);
}

LeafQuery makeQuery(const std::vector<Facet>& facets, float half_width, LeafScratch& scratch,
                    float* squares) {
  const std::size_t count = facets.size();
  const std::size_t lists = 8 * (count + 1);
  if (scratch.nearby.size() < lists) {
    scratch.distances.resize(8 * count);
    // One more entry in each: an entry is written before it is known whether it stays.
    scratch.nearby.resize(lists);
    scratch.close.resize(lists);
  }
  return {facets.data(),
          static_cast<std::uint32_t>(count),
          half_width,
          scratch.distances.data(),
          scratch.nearby.data(),
          scratch.close.data(),
          squares};
}

}  // namespace palpate::vdb
