#pragma once
/// Stable sorting by integer keys, in time linear in the count.

#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace palpate::vdb {

/// Sorts by key(value), a std::uint64_t below 2^bits. Equal keys keep their order.
template <typename Value, typename Key>
void radixSort(std::vector<Value>& values, int bits, const Key& key) {
  constexpr int kDigit = 11;
  constexpr std::uint64_t kMask = (std::uint64_t{1} << kDigit) - 1;
  std::vector<Value> other(values.size());
  for (int shift = 0; shift < bits; shift += kDigit) {
    std::array<std::size_t, kMask + 1> place{};
    for (const Value& value : values) ++place[key(value) >> shift & kMask];
    std::size_t sum = 0;
    for (std::size_t& start : place) sum += std::exchange(start, sum);
    for (const Value& value : values) other[place[key(value) >> shift & kMask]++] = value;
    values.swap(other);
  }
}

/// Number of bits that hold every number up to `most`.
[[nodiscard]] inline int bitsFor(std::uint64_t most) {
  return static_cast<int>(std::bit_width(most));
}

}  // namespace palpate::vdb
