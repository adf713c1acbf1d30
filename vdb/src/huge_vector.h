#pragma once
/// A vector that asks for huge pages.

#include <cstddef>
#include <cstdlib>
#include <vector>

namespace palpate::vdb {

/// Allocates memory, in huge pages if it is large and the system has some; free it with
/// std::free(). Huge pages are only a request: without them everything works, but slower. @throws
/// std::bad_alloc
[[nodiscard]] void* allocateHuge(std::size_t bytes, std::size_t alignment);

template <typename T>
struct HugeAllocator {
  using value_type = T;  // NOLINT(readability-identifier-naming): the standard's name

  HugeAllocator() noexcept = default;
  template <typename Other>
  explicit(false) HugeAllocator(const HugeAllocator<Other>& /*unused*/) noexcept {}

  [[nodiscard]] T* allocate(std::size_t count) {
    return static_cast<T*>(allocateHuge(count * sizeof(T), alignof(T)));
  }
  void deallocate(T* memory, std::size_t /*count*/) noexcept { std::free(memory); }
  friend bool operator==(const HugeAllocator& /*a*/, const HugeAllocator& /*b*/) noexcept {
    return true;
  }
};

/// For blocks of some kilobytes each that are read together with many neighbors: with small pages,
/// most of the time would go into address translation.
template <typename T>
using HugeVector = std::vector<T, HugeAllocator<T>>;

}  // namespace palpate::vdb
