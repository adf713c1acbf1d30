#pragma once
/// The nearest point that some walls allow, near a point that they allow.

#include <array>
#include <span>

#include "palpate/contact/slide.h"

namespace palpate {

/// The nearest point to `target` with side * S >= 0 for all of `walls` (field, side and tolerance
/// of each are read), found by Newton's steps from `from`, which is such a point: no rim, port or
/// sheet takes part.
struct LocalProjection {
  Vec3 at{0.0, 0.0, 0.0};          ///< [m]
  std::array<HeldWall, 3> held{};  ///< the walls that hold it there
  std::size_t count = 0;
  bool settled = false;  ///< false: it did not converge, or a field is out of its band

  [[nodiscard]] std::span<const HeldWall> walls() const noexcept { return {held.data(), count}; }
};
/// Walls that one projection takes part in; more are left out.
inline constexpr std::size_t kMaxProjectionWalls = 16;

/// Real-time safe: at most 40 looks at each wall.
[[nodiscard]] LocalProjection projectLocally(const Vec3& from, const Vec3& target,
                                             std::span<const HeldWall> walls) noexcept;

/// The same for walls that are hollow towards `from`, also at a tip or a fold, where Newton's steps
/// find no end: the tangent plane of a hollow wall holds everywhere, so each place that is beyond a
/// wall adds one, and the nearest point that all of them allow is the next place (Kelley, "The
/// cutting-plane method for solving convex programs", 1960). Of a wall that bulges, a tangent plane
/// cuts off `from`: then it is not settled. The walls that hold the point are these planes, without
/// bends. Real-time safe: at most 64 looks at each wall.
[[nodiscard]] LocalProjection projectByCuts(const Vec3& from, const Vec3& target,
                                            std::span<const HeldWall> walls) noexcept;

}  // namespace palpate
