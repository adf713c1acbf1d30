#pragma once
/// Order statistics of times.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace palpate::tools {

/// The smallest value v such that at least the share `share` of the sorted values are at most v; 0
/// if there are none.
[[nodiscard]] inline double quantile(std::span<const std::int64_t> sorted, double share) {
  if (sorted.empty()) return 0.0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return static_cast<double>(sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1]);
}

}  // namespace palpate::tools
