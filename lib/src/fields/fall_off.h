#pragma once
/// The fall-offs of metaballs, and how steep a sum of them can be. Private to fields.

#include <vector>

#include "palpate/fields/implicit.h"

namespace palpate::fields {

/// A fall-off as a function of t = q^2, with its derivatives by t.
struct Kernel {
  double value = 0.0;
  double first = 0.0;
  double second = 0.0;
};

template <FallOff kFallOff>
[[nodiscard]] Kernel kernelAt(double t) noexcept {
  if constexpr (kFallOff == FallOff::kWyvill) {
    const double s = t < 1.0 ? 1.0 - t : 0.0;
    return {s * s * s, -3.0 * s * s, 6.0 * s};
  } else if constexpr (kFallOff == FallOff::kGaussian) {
    const double e = std::exp(-t);
    return {e, -e, e};
  } else {
    const double s = 1.0 / (1.0 + t);
    return {s, -s * s, 2.0 * s * s * s};
  }
}

/// The q at which the fall-off has come down to `value`, 0 < value < 1.
[[nodiscard]] double reachOf(FallOff fall_off, double value);

/// The steepest slope, as a derivative by q, between `lo` and `hi`.
[[nodiscard]] double steepest(FallOff fall_off, double lo, double hi);

/// An upper bound on the slope of the sum of strength * fall-off anywhere [1/m].
[[nodiscard]] double steepestSum(const std::vector<Metaball>& balls, FallOff fall_off);

}  // namespace palpate::fields
