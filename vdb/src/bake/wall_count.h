#pragma once
/// Counts the walls that a line along z meets.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

struct WallHit {
  double z = 0.0;
  int entered = 0;  ///< walls entered on the way up minus walls left; 0: no wall here
};

/// Twice the area of a, b and (x, y) seen along z; positive if (x, y) is left of a -> b.
[[nodiscard]] inline double leftOf(const Vec3& a, const Vec3& b, double x, double y) noexcept {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

/// The contribution of a side to the winding number of its triangle about (x, y): whether it
/// crosses the line from there towards +x, upwards or downwards. Both triangles of an edge compute
/// the very same number, so that the sum over a closed surface is zero whatever the rounding.
[[nodiscard]] inline int crossesUpwards(const Vec3& from, const Vec3& to, double x,
                                        double y) noexcept {
  if (from.y <= y && to.y > y) return leftOf(from, to, x, y) > 0.0 ? 1 : 0;
  if (to.y <= y && from.y > y) return leftOf(to, from, x, y) > 0.0 ? -1 : 0;
  return 0;
}

/// Where the line through (x, y) meets the wall a, b, c.
[[nodiscard]] inline WallHit hitWall(const Vec3& a, const Vec3& b, const Vec3& c, double x,
                                     double y) noexcept {
  const int turns =
      crossesUpwards(a, b, x, y) + crossesUpwards(b, c, x, y) + crossesUpwards(c, a, x, y);
  if (turns == 0) return {};
  const double u = leftOf(b, c, x, y);
  const double v = leftOf(c, a, x, y);
  const double w = leftOf(a, b, x, y);
  const double sum = u + v + w;
  const double lo = std::min({a.z, b.z, c.z});
  const double hi = std::max({a.z, b.z, c.z});
  const double z = sum != 0.0 ? (u * a.z + v * b.z + w * c.z) / sum : lo;
  // A wall that is counterclockwise seen from above is an upper side, through which +z leaves the
  // solid.
  return {std::clamp(z, lo, hi), -turns};
}

/// The winding numbers of a solid's parts on the way up a line; only those that are not zero.
class WallCount {
 public:
  /// `roles`: for each part, +1 solid or -1 cavity; must outlive the count.
  explicit WallCount(const std::vector<int>& roles) : roles_(roles) {}

  void add(std::uint32_t part, int entered) {
    for (auto count = counts_.begin(); count != counts_.end(); ++count) {
      if (count->first != part) continue;
      count->second += entered;
      if (count->second == 0) {
        change(roles_[part], -1);
        counts_.erase(count);
      }
      return;
    }
    counts_.emplace_back(part, entered);
    change(roles_[part], 1);
  }
  void clear() {
    counts_.clear();
    sum_ = 0;
    cavities_ = 0;
  }
  [[nodiscard]] const std::vector<std::pair<std::uint32_t, int>>& all() const { return counts_; }
  [[nodiscard]] bool isInside() const { return sum_ > 0; }
  [[nodiscard]] bool isInCavity() const { return cavities_ > 0; }

 private:
  void change(int role, int by) {
    sum_ += by * role;
    if (role < 0) cavities_ += by;
  }

  const std::vector<int>& roles_;
  std::vector<std::pair<std::uint32_t, int>> counts_;
  int sum_ = 0;
  int cavities_ = 0;
};

}  // namespace palpate::vdb
