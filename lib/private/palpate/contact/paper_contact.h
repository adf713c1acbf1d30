#pragma once
/// Algorithms I and II of Maneewarn, Hannaford, Storti and Ganter, "Haptic rendering for internal
/// content of an implicit object", to the letter. The contact point Po is driven by the probe's own
/// motion, so it drifts and is re-acquired where the surface is curved. That belongs to the method,
/// which is kept for comparison.

#include "palpate/fields/field.h"

namespace palpate {

/// One surface, felt from outside (side +1) or, with its sign reversed, from within (side -1).
struct PaperSurface {
  const Field* field = nullptr;
  double side = 1.0;
  double epsilon = 1e-6;     ///< |S| that counts as on the surface, in units of S
  double alpha = 1.0;        ///< [-] share of the nudge
  bool newton_form = false;  ///< alpha S N / (N.N) instead of the printed alpha S N / |N|
  int max_halvings =
      48;  ///< MAX_N: halvings of the segment that is searched; as PaperParameters::kMaxHalvings

  /// S and N with the side applied: negative beyond the wall, N towards the hand's side.
  [[nodiscard]] FieldSample at(const Vec3& p) const noexcept;
};

/// The two points of the force law f = K (Po - Pi) - B V.
struct PaperContact {
  Vec3 surface_point{0.0, 0.0, 0.0};      ///< [m] Po
  Vec3 interaction_point{0.0, 0.0, 0.0};  ///< [m] Pi: the probe projected on the normal line of Po
};

/// Algorithm I, first contact: bisects from the probe's last position (outside) to its present one.
/// If the segment does not cross the surface (the probe began beyond the wall), Po is found by
/// following the gradient.
[[nodiscard]] PaperContact firstContact(const PaperSurface& surface, const Vec3& outside,
                                        const Vec3& probe) noexcept;

/// Algorithm II, still in contact: Po follows the probe's motion, and if it left the surface it is
/// re-acquired by Algorithm I on Po..Pi (or Po..P where Pi is outside).
[[nodiscard]] PaperContact trackContact(const PaperSurface& surface, const PaperContact& last,
                                        const Vec3& last_probe, const Vec3& probe) noexcept;

}  // namespace palpate
