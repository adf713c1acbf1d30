#pragma once
/// How fields answer for a whole batch: loops without branches, which the compiler turns into
/// vector code, and what these leave out once more, one by one. Private to fields.

#include <cmath>
#include <cstdint>

#include "fields/vector.h"
#include "palpate/fields/field.h"

namespace palpate::fields {

/// One number for each point of a batch. Loops over these are right only for plain squares
/// (isPlainSquare()); the others are left to the caller.
struct alignas(64) Squares : std::array<double, PointBatch::kCount> {};

/// Whether all are plain, and not close to leaving the range of double together. Two at a time,
/// which compilers do not see by themselves.
[[nodiscard]] inline bool arePlain(const Squares& squares) noexcept {
  using Two [[gnu::vector_size(16)]] = double;
  Two least{1.0, 1.0};
  Two total{0.0, 0.0};  // what is not a number makes it one that is not
  for (std::size_t n = 0; n < PointBatch::kCount; n += 2) {
    const Two square{squares[n], squares[n + 1]};
    least = square < least ? square : least;
    total += square;
  }
  return isPlainSquare(least[0]) && isPlainSquare(least[1]) && total[0] < 1e300 && total[1] < 1e300;
}

/// The field's own value() for what a loop left over.
template <class F>
void valuesOfLeftovers(const F& field, const PointBatch& points, const Squares& squares,
                       ValueBatch& out) noexcept {
  if (arePlain(squares)) [[likely]]
    return;
  for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
    if (!isPlainSquare(squares[n])) out[n] = field.F::value(points[n]);
  }
}

}  // namespace palpate::fields
