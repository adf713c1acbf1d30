#pragma once
/// The nearest point that some walls allow, near a point that they allow.

#include <array>
#include <span>

#include "palpate/contact/slide.h"

namespace palpate {

/// The nearest point to `target` with side * S >= 0 for all of `walls` (field, side and tolerance of each are
/// read), found by Newton's steps from `from`, which is such a point: no rim, port or sheet takes part.
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

}  // namespace palpate
