#pragma once
/// The nearest point that satisfies some walls, near a point that satisfies them.

#include <array>
#include <span>

#include "palpate/contact/slide.h"

namespace palpate {

/// The nearest point to `target` with side * S >= 0 for all of `walls` (field, side and tolerance
/// of each are used), found by Newton's steps starting at `from`, which satisfies the walls. Rims,
/// ports and sheets are ignored.
struct LocalProjection {
  Vec3 at{0.0, 0.0, 0.0};          ///< [m]
  std::array<HeldWall, 3> held{};  ///< the walls that hold it there
  std::size_t count = 0;
  bool settled = false;  ///< false: it did not converge, or a field is outside its band

  [[nodiscard]] std::span<const HeldWall> walls() const noexcept { return {held.data(), count}; }
};
/// The most walls that one projection uses; more are left out.
inline constexpr std::size_t kMaxProjectionWalls = 16;

/// Real-time safe: evaluates each wall at most 40 times.
[[nodiscard]] LocalProjection projectLocally(const Vec3& from, const Vec3& target,
                                             std::span<const HeldWall> walls) noexcept;

/// The same for walls on whose free side the region is convex, also at a tip or a fold, where
/// Newton's steps do not converge. The tangent plane of such a wall is a valid bound everywhere; so
/// each place beyond a wall adds a plane, and the nearest point that satisfies all planes is the
/// next place (Kelley, "The cutting-plane method for solving convex programs", 1960). If a wall
/// bulges towards `from`, its tangent plane cuts off `from`, and the result is not settled. The
/// walls in the result are these planes, without curvature. Real-time safe: evaluates each wall at
/// most 64 times.
[[nodiscard]] LocalProjection projectByCuts(const Vec3& from, const Vec3& target,
                                            std::span<const HeldWall> walls) noexcept;

}  // namespace palpate
