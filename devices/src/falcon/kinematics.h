#pragma once
// Kinematics of a Novint Falcon: the position of its grip for given angles of its three arms, and
// the torques of its motors for a given force.
//
// It is a delta robot of Tsai's kind; the equations follow R. E. Stamper, "A Three Degree of
// Freedom Parallel Manipulator with Only Translational Degrees of Freedom", PhD thesis, University
// of Maryland 1997, equations 3.1 to 3.9 and 4.12. The lengths are public measurements of the
// device, unverified on hardware.

#include <optional>

#include "palpate/core/math.h"

namespace palpate::devices::falcon {

/// [m] Geometry in the frame of the base, whose z axis is the robot's axis and points away from it.
struct Geometry {
  double thigh = 0.060;      ///< a: from the motor's axis to the knee
  double shin = 0.1025;      ///< b: the long side of the parallelogram
  double grip = 0.01443;     ///< c: from the grip's center to its hinge
  double hinge = 0.0225;     ///< d + e: the short links at both ends of the parallelogram
  double sideways = -0.025;  ///< f
  double radius = 0.0400;    ///< (r) distance of the motors' axes from the axis of the base
  double shift = -0.02309;   ///< (s) sideways offset of the motors' axes
  double turn = 15.0;        ///< [degrees] added to the azimuths 90, -30 and -150 of the legs
};

/// The arms' angles, and the derivatives of the angles by the grip's position. The inverse of that
/// matrix is not stored.
struct Arms {
  Vec3 angles{0.0, 0.0, 0.0};  ///< [rad] of the three thighs
  Mat3 slope{0.0};             ///< slope[column][row]: d angle(row) / d position(column)
};

/// No value where the grip cannot be, or where an arm is stretched.
[[nodiscard]] std::optional<Arms> armsAt(const Vec3& position,
                                         const Geometry& geometry = {}) noexcept;

struct Grip {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m]
  int iterations = 0;
};

/// Newton's method, started at `near`, to 1e-12 m. If it does not converge within kMostIterations,
/// it goes towards the angles in 16 steps with that many iterations each; no value if that fails
/// too. Bounded work; real-time safe.
[[nodiscard]] std::optional<Grip> gripAt(const Vec3& angles, const Vec3& near,
                                         const Geometry& geometry = {}) noexcept;
constexpr int kMostIterations = 20;

/// [m] A place from which gripAt() converges to every place of the workspace.
[[nodiscard]] inline Vec3 middle() noexcept { return {0.0, 0.0, 0.11}; }

/// Torques [Nm] that the motors must exert at the thighs for the hand to feel `force` [N]: the
/// transpose of d(position) / d(angles), times the force. No value where the arms are singular.
[[nodiscard]] std::optional<Vec3> torquesFor(const Vec3& force, const Arms& arms) noexcept;

}  // namespace palpate::devices::falcon
