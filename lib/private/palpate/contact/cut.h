#pragma once
/// The way that a tip cuts through a tissue, and the force that it takes.

#include <span>

#include "palpate/contact/slide.h"
#include "palpate/core/math.h"

namespace palpate {

/// A straight cut, from where the tip entered a tissue to the furthest it got. Within the cut, and
/// on the straight way out of it, the tip moves freely; against its end and its sides it presses
/// with a spring, and where that would take more than the cutting force, it cuts: end or side give
/// way and stay where they are then. So the spring is never switched off: it is anchored to tissue
/// that moves along with the tip, and only slackens when the tip is drawn back (the tracking wall
/// of Alamilla Daniel, Moreau and Redarce 2018). A value; real-time safe. Passive: apart from
/// cutting it is a spring to a convex set.
class Cut {
 public:
  Cut() = default;
  explicit Cut(const Vec3& entry) noexcept : entry_(entry), end_(entry) {}

  /// The tip is at `tip` [m]; the tissue is as stiff as `stiffness` [N/m] and gives way at
  /// `cutting_force` [N]. Returns the force [N] on the tip.
  [[nodiscard]] Vec3 step(const Vec3& tip, double stiffness, double cutting_force) noexcept;
  /// The tip is at `tip` [m], on the walls `rests_on` (at most 3), which cannot be cut: the tissue
  /// before them is cut through, and presses no more against them. Comes before step().
  void restOn(const Vec3& tip, std::span<const HeldWall> rests_on) noexcept;

  [[nodiscard]] const Vec3& entry() const noexcept { return entry_; }  ///< [m]
  [[nodiscard]] const Vec3& end() const noexcept { return end_; }      ///< [m]
  /// The tip went out through `point` [m], at the end of this tissue: all the way there is cut.
  void passTo(const Vec3& point) noexcept { end_ = point; }
  /// The same cut, entered at `entry` [m].
  [[nodiscard]] Cut enteredAt(const Vec3& entry) const noexcept {
    Cut out(entry);
    out.end_ = end_;
    return out;
  }

 private:
  /// Where a tip at `tip` [m] is free to be, nearest to it.
  struct Near {
    Vec3 point{0.0, 0.0, 0.0};  ///< [m]
    Vec3 way{0.0, 0.0, 0.0};    ///< [m] of the cut
    double length = 0.0;        ///< [m] of it
    double share = 1.0;         ///< [-] of it that lies before the tip: 1 at its end or beyond
  };
  [[nodiscard]] Near nearest(const Vec3& tip) const noexcept;
  void moveTo(const Near& near, const Vec3& torn) noexcept;

  Vec3 entry_{0.0, 0.0, 0.0};
  Vec3 end_{0.0, 0.0, 0.0};
};

}  // namespace palpate
