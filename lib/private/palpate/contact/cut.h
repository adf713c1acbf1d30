#pragma once
/// The cut that a tip makes through a tissue, and the force that this takes.

#include <span>

#include "palpate/contact/slide.h"
#include "palpate/core/math.h"

namespace palpate {

/// A straight cut, from where the tip entered a tissue to the furthest point it reached. Within the
/// cut, and on its straight extension backwards, the tip moves freely; against the cut's end and
/// its sides it presses with a spring. Where the spring would need more than the cutting force, the
/// tip cuts: the end or side moves with it and then stays there. So the spring is never switched
/// off: it is anchored to tissue that moves along with the tip, and only slackens when the tip is
/// drawn back (the tracking wall of Alamilla Daniel, Moreau and Redarce 2018). A value type;
/// real-time safe. Passive: apart from cutting it is a spring to a convex set.
class Cut {
 public:
  Cut() = default;
  explicit Cut(const Vec3& entry) noexcept : entry_(entry), end_(entry) {}

  /// The tip is at `tip` [m]; the tissue is as stiff as `stiffness` [N/m] and gives way at
  /// `cutting_force` [N]. Returns the force [N] on the tip.
  [[nodiscard]] Vec3 step(const Vec3& tip, double stiffness, double cutting_force) noexcept;
  /// The tip is at `tip` [m], on the walls `rests_on` (at most 3), which cannot be cut: the tissue
  /// in front of them is cut through, and the tip no longer presses it against them. To be called
  /// before step().
  void restOn(const Vec3& tip, std::span<const HeldWall> rests_on) noexcept;

  [[nodiscard]] const Vec3& entry() const noexcept { return entry_; }  ///< [m]
  [[nodiscard]] const Vec3& end() const noexcept { return end_; }      ///< [m]
  /// The tip left this tissue through `point` [m]: everything up to there is cut.
  void passTo(const Vec3& point) noexcept { end_ = point; }
  /// The same cut, entered at `entry` [m].
  [[nodiscard]] Cut enteredAt(const Vec3& entry) const noexcept {
    Cut out(entry);
    out.end_ = end_;
    return out;
  }

 private:
  /// The point nearest to a tip at `tip` [m] at which the tip is free.
  struct Near {
    Vec3 point{0.0, 0.0, 0.0};  ///< [m]
    Vec3 way{0.0, 0.0, 0.0};    ///< [m] from the entry to the end of the cut
    double length = 0.0;        ///< [m] of `way`
    double share = 1.0;  ///< [-] share of the cut that lies before the tip: 1 at its end or beyond
  };
  [[nodiscard]] Near nearest(const Vec3& tip) const noexcept;
  void moveTo(const Near& near, const Vec3& torn) noexcept;

  Vec3 entry_{0.0, 0.0, 0.0};
  Vec3 end_{0.0, 0.0, 0.0};
};

}  // namespace palpate
