#pragma once
/// Finds where a moving point first meets a surface: conservative advancement by the Lipschitz
/// bound.

#include <cstdint>

#include "palpate/fields/field.h"

namespace palpate {

/// One surface as used by the sweep: `side * S` is positive on the side that the point is on.
struct SweepSurface {
  const Field* field = nullptr;
  double side = 1.0;       ///< +1 outside, -1 inside
  double lipschitz = 1.0;  ///< of the field
  double tolerance = 0.0;  ///< |S| that counts as on the surface
  double graze = 0.0;      ///< [m] shortest step: a shorter passage in and out again is ignored
  bool is_flat = false;    ///< Field::isFlat()
  double allowance = 0.0;  ///< |S| beyond the surface that still counts as on the near side
};

struct SweepResult {
  enum class Kind : std::uint8_t {
    kFree,    ///< the whole segment stays on its side
    kHit,     ///< at `at` the point is on the surface and the motion leads through it
    kUnsure,  ///< out of budget; the segment is free up to `at`
  };
  Kind kind = Kind::kFree;
  double at = 1.0;  ///< share of the segment, 0 to 1; on the near side to within the tolerance
  double end_value =
      0.0;  ///< side * S + allowance at the end of the swept part (a lower bound of |S| there)
};

/// Sweeps from `a` to `b` [m]. `start` is side * S + allowance at `a`. A start on or beyond the
/// surface counts as a hit if the motion leads further beyond, and as free if it leads away. At
/// most `budget` evaluations.
[[nodiscard]] SweepResult sweep(const SweepSurface& surface, const Vec3& a, const Vec3& b,
                                double start, int budget) noexcept;

}  // namespace palpate
