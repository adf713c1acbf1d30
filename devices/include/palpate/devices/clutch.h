#pragma once
/// A clutch: while it is held the world stands still under a hand that goes elsewhere.

#include <algorithm>

#include "palpate/core/math.h"

namespace palpate::devices {

/// What the clutch makes of one reading.
struct Clutched {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world] where the probe is
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s, world] of the probe, as drag and damping are to feel it
  double share = 1.0;            ///< [-] of the force that the hand gets
};

/// A value type, real-time safe. The reading with which the clutch is engaged, and that with which it is let go, have the position,
/// the velocity and the share of the force that they would have had without; what changes begins with the next one. From there on
/// the force fades to nothing, or comes back, and the velocity goes from what it was to zero, or to the hand's, as
/// 3 s^2 - 2 s^3 over kFade: a drag that stopped at once would be a kick.
class Clutch {
 public:
  static constexpr double kFade = 0.05;  ///< [s]

  /// `position` [m, world] and `velocity` [m/s, world] of the reading by the mapping alone; `dt` [s] since the last reading,
  /// of which nothing below 0 counts.
  [[nodiscard]] Clutched step(const Vec3& position, const Vec3& velocity, bool is_held,
                              double dt) noexcept {
    const double change = dt > 0.0 ? std::min(1.0, dt / kFade) : 0.0;
    fade_ = is_held_ ? std::max(0.0, fade_ - change) : std::min(1.0, fade_ + change);
    turned_ = std::min(1.0, turned_ + change);
    const Vec3 to = is_held_ ? Vec3(0.0) : velocity;
    const Clutched out{is_held_ ? held_ : position + shift_,
                       turned_ < 1.0 ? from_ + smooth(turned_) * (to - from_) : to, smooth(fade_)};
    if (is_held != is_held_) {
      is_held_ = is_held;
      if (is_held) held_ = out.position;
      if (!is_held) shift_ = held_ - position;
      from_ = out.velocity;
      turned_ = 0.0;
    }
    return out;
  }

 private:
  [[nodiscard]] static double smooth(double s) noexcept { return s * s * (3.0 - 2.0 * s); }

  bool is_held_ = false;
  double fade_ = 1.0;          ///< [-] of the force, before it is smoothed
  double turned_ = 1.0;        ///< [-] how far the velocity got since the clutch turned
  Vec3 from_{0.0, 0.0, 0.0};   ///< [m/s, world] the velocity with which it turned
  Vec3 shift_{0.0, 0.0, 0.0};  ///< [m, world] that all clutching so far has added
  Vec3 held_{0.0, 0.0, 0.0};   ///< [m, world]
};

}  // namespace palpate::devices
