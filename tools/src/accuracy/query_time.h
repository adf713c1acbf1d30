#pragma once
/// Measures how long a query for value and gradient takes.

#include <span>

#include "cache_flood.h"
#include "palpate/fields/field.h"

namespace palpate::tools {

struct QueryTimes {
  double independent = 0.0;  ///< [ns] one after another along a path
  double dependent = 0.0;    ///< [ns] each position waits for the last result, as in a servo loop
  double cold = 0.0;  ///< [ns] one query alone, after other data went through the caches; median
};

/// Times queries along `path` [m]: the shortest of `repeats` runs; cold ones at `cold_queries`
/// places spread over `scattered`. `clock_ns` is subtracted from each cold query.
[[nodiscard]] QueryTimes timeQueries(const Field& field, std::span<const Vec3> path,
                                     std::span<const Vec3> scattered, int repeats,
                                     std::size_t cold_queries, double clock_ns, CacheFlood& flood);

}  // namespace palpate::tools
