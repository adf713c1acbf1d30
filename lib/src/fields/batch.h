#pragma once
/// How fields answer for a whole batch: loops without branches, which the compiler turns into vector
/// code, and what these leave out once more, one by one. Private to fields.

#include <cmath>
#include <cstdint>

#include "fields/vector.h"
#include "palpate/fields/field.h"

namespace palpate::fields {

/// Which points of a batch the loop was not made for: not 0. As wide as the numbers beside it.
using Leftovers = std::array<std::int64_t, PointBatch::kCount>;

/// isPlainSquare(), without a branch.
[[nodiscard]] inline bool isPlain(double square) noexcept {
  return (square > 1e-280) & (square < 1e300);
}

/// The field's own value() for what a loop left over.
template <class F>
void valuesOfLeftovers(const F& field, const PointBatch& points, const Leftovers& left,
                       ValueBatch& out) noexcept {
  std::int64_t any = 0;
  for (const std::int64_t one : left) any |= one;
  if (any == 0) [[likely]]
    return;
  for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
    if (left[n] != 0) out[n] = field.F::value(points[n]);
  }
}

}  // namespace palpate::fields
