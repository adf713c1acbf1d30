#pragma once
// The header of a record's array file, and what its rows are made of.

#include <cstddef>
#include <cstdint>
#include <string>

#include "palpate/devices/record.h"

namespace palpate::devices {

[[nodiscard]] inline Vec3 vectorOf(const TickRecord::Vector& a) noexcept {
  return {a[0], a[1], a[2]};
}

/// Where the number of rows stands in the header, right-aligned.
inline constexpr std::size_t kCountDigits = 20;

struct RowHeader {
  std::string text;          ///< all of it, from the magic to the line's end
  std::size_t count_at = 0;  ///< of the first of kCountDigits
};

/// Of an array of `count` TickRecords, by the format 1.0 of NumPy.
[[nodiscard]] const RowHeader& emptyRowHeader();
/// The digits that say so.
[[nodiscard]] std::string countDigits(std::uint64_t count);

}  // namespace palpate::devices
