#pragma once
// Finds the exact nearest allowed point to a point that is near the allowed set.

#include <optional>
#include <vector>

#include "support/oracle/feasible_set.h"

namespace palpate::oracle {

struct LocalPoint {
  Vec3 point{0.0, 0.0, 0.0};
  std::vector<std::size_t> active = {};  ///< sides of the set on whose surfaces it lies
  std::vector<double> multipliers = {};  ///< point - q = sum multiplier * gradient of side
  bool smooth = true;  ///< false: found by searching directions (a cusp, a kink inside a field)
};

/// The point of `set` nearest to `q` among those within `radius` of it. One must exist; `allowed`
/// is such a point, if the caller knows one. In every branch all subsets of up to three sides are
/// tried, and each is solved to rounding, because alternating projections stall at creases. Where
/// no subset has a solution (a cusp, an apex, a kink), directions are searched by values alone,
/// which takes some milliseconds.
[[nodiscard]] LocalPoint projectLocally(const FeasibleSet& set, const Vec3& q, double radius,
                                        const std::optional<Vec3>& allowed = {});

/// True if `p` keeps all sides of a branch, to 1e-11 of their feature sizes.
[[nodiscard]] bool isAllowed(const FeasibleSet& set, const Vec3& p);

/// Solves the n x n system a x = b in place, n = b.size(), row major; false if singular.
[[nodiscard]] bool solveLinear(std::vector<double>& a, std::vector<double>& b);

}  // namespace palpate::oracle
