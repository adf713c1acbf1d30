#include "huge_vector.h"

#if defined(__unix__)
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <new>

namespace palpate::vdb {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;
/// [bytes] Huge pages are used from this size on, so that rounding up by a page wastes little.
constexpr std::size_t kWorthHugePages = 2 * kHugePage;

}  // namespace

void* allocateHuge(std::size_t bytes, std::size_t alignment) {
  const bool huge = bytes >= kWorthHugePages;
  const std::size_t aligned = std::max(huge ? kHugePage : alignof(std::max_align_t), alignment);
  const std::size_t size = (std::max<std::size_t>(bytes, 1) + aligned - 1) / aligned * aligned;
  void* const memory = std::aligned_alloc(aligned, size);
  if (memory == nullptr) throw std::bad_alloc();
#if defined(MADV_HUGEPAGE)
  if (huge) static_cast<void>(::madvise(memory, size, MADV_HUGEPAGE));
#endif
  return memory;
}

}  // namespace palpate::vdb
