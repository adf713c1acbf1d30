#pragma once
/// How fields answer a whole batch: branch-free loops, which the compiler turns into vector code,
/// and then one by one those points that the loops cannot handle. Private to fields.

#include <cmath>
#include <cstdint>

#include "fields/vector.h"
#include "palpate/fields/field.h"

namespace palpate::fields {

/// One number for each point of a batch. Loops over these are right only for plain squares
/// (isPlainSquare()); the caller handles the others.
struct alignas(64) Squares : std::array<double, PointBatch::kCount> {};

/// Whether all are plain, and their sum is not close to the limit of double. It works on two at a
/// time, a vectorization that compilers do not find by themselves.
[[nodiscard]] inline bool arePlain(const Squares& squares) noexcept {
  using Two [[gnu::vector_size(16)]] = double;
  Two least{1.0, 1.0};
  Two total{0.0, 0.0};  // any NaN makes the total NaN
  for (std::size_t n = 0; n < PointBatch::kCount; n += 2) {
    const Two square{squares[n], squares[n + 1]};
    least = square < least ? square : least;
    total += square;
  }
  return isPlainSquare(least[0]) && isPlainSquare(least[1]) && total[0] < 1e300 && total[1] < 1e300;
}

/// The field's own value() for the points that a loop could not handle.
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
