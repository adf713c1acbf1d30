#pragma once
// Computes what a perfect constraint renderer's proxy does in one tick, slowly and by an
// independent method. README.md beside this file says what may be compared with it.

#include <cstddef>
#include <vector>

#include "support/oracle/feasible_set.h"

namespace palpate::oracle {

struct OracleSettings {
  /// Step h of the flow [m]; 0: 1/50 of the smallest feature. A second run uses h / 10.
  double step = 0.0;
  std::size_t most_steps = 200000;
};

struct OracleResult {
  Vec3 proxy{0.0, 0.0, 0.0};  ///< [m] from the run with h / 10
  /// The runs differ: either result is right, and a test must skip the tick
  bool ambiguous = false;
  bool converged = false;  ///< reached a second-order stationary point, or the HIP
  /// False: the proxy ends at a cusp or kink, known to about 1e-7 of the depth
  bool smooth = true;
  /// How far one more step of the flow moves the proxy, as a share of that step [-].
  double residual = 0.0;
  std::size_t steps = 0;
  std::vector<std::size_t> active = {};  ///< sides of the set it rests on; empty where it is free

  /// |x - proxy| / |proxy - hip|, which does not depend on the scale; if the depth is below
  /// `least_depth` [m], relative to that.
  [[nodiscard]] double errorOf(const Vec3& x, const Vec3& hip, double least_depth = 1e-9) const;
};

/// Starts from the renderer's own `previous` proxy and computes the limit h -> 0 of x <- project(x
/// + h (P - x)/|P - x|), with P = `hip` fixed. `previous` need not be exactly allowed, only near an
/// allowed point.
[[nodiscard]] OracleResult solveOracle(const FeasibleSet& set, const Vec3& previous,
                                       const Vec3& hip, const OracleSettings& settings = {});

}  // namespace palpate::oracle
