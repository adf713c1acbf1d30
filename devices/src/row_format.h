#pragma once
// The header of a record's array file, and the format of its rows.

#include <cstddef>
#include <cstdint>
#include <string>

#include "palpate/devices/record.h"

namespace palpate::devices {

[[nodiscard]] inline Vec3 vectorOf(const TickRecord::Vector& a) noexcept {
  return {a[0], a[1], a[2]};
}

/// Number of digits of the row count in the header, right-aligned.
inline constexpr std::size_t kCountDigits = 20;

struct RowHeader {
  std::string text;          ///< the whole header, from the magic to the end of the line
  std::size_t count_at = 0;  ///< offset of the first of the kCountDigits digits
};

/// The header for an array of 0 TickRecords, in NumPy's format 1.0.
[[nodiscard]] const RowHeader& emptyRowHeader();
/// The digits of `count`, padded to kCountDigits.
[[nodiscard]] std::string countDigits(std::uint64_t count);

}  // namespace palpate::devices
