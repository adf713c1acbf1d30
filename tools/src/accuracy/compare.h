#pragma once
/// Measures how far a field is off the truth, at points and along strokes.

#include <optional>
#include <span>
#include <vector>

#include "accuracy/points.h"
#include "bench/spread.h"

namespace palpate::tools {

struct Errors {
  std::size_t points = 0;       ///< compared
  std::size_t out_of_band = 0;  ///< where the field has no gradient; not compared
  Spread value;                 ///< [m]
  Spread normal;                ///< [degrees] between gradient and true normal
  Spread curvature;             ///< [1/m] error of the mean curvature, from the Hessian
};

/// Which expression of a field counts as its distance.
enum class ValueIs {
  kDistance,   ///< the value
  kOverSlope,  ///< value / |gradient|
};

/// Compares those of `points` whose `smooth` equals the argument.
[[nodiscard]] Errors errorsAt(const Field& field, std::span<const JudgedPoint> points, bool smooth,
                              ValueIs value_is = ValueIs::kDistance);

/// |n[i+1] - 2 n[i] + n[i-1]| of unit normals along strokes: how much the change of force from tick
/// to tick jumps, in N for each N of contact force.
struct Jitter {
  std::size_t points = 0;  ///< where all three normals were known, away from edges
  Spread field;            ///< [-]
  Spread truth;            ///< [-] of the exact surface at the same points
};

[[nodiscard]] Jitter jitterOf(const Field& field, std::span<const Stroke> strokes);

/// Slope of log error over log h, by least squares: p, if the error is proportional to h^p. Nothing
/// for fewer than two sizes, or if an error is 0.
[[nodiscard]] std::optional<double> fittedOrder(std::span<const double> h,
                                                std::span<const double> error);

}  // namespace palpate::tools
