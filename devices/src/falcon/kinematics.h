#pragma once
// Where the grip of a Novint Falcon is when its three arms stand so, and what its motors must do
// for a force.
//
// A delta robot of Tsai's kind; after R. E. Stamper, "A Three Degree of Freedom Parallel
// Manipulator with Only Translational Degrees of Freedom", PhD thesis, University of Maryland 1997,
// equations 3.1 to 3.9 and 4.12. The lengths are public measurements of the device, unverified on
// hardware.

#include <optional>

#include "palpate/core/math.h"

namespace palpate::devices::falcon {

/// [m] Frame: the base's, z along the axis away from it.
struct Geometry {
  double thigh = 0.060;      ///< a: from the motor's axis to the knee
  double shin = 0.1025;      ///< b: the long side of the parallelogram
  double grip = 0.01443;     ///< c: from the grip's center to its hinge
  double hinge = 0.0225;     ///< d + e: the short links at both ends of the parallelogram
  double sideways = -0.025;  ///< f
  double radius = 0.0400;    ///< r: of the motors' axes about the base's
  double shift = -0.02309;   ///< s: sideways, of the same
  double turn = 15.0;        ///< [degrees] added to the azimuths 90, -30 and -150 of the legs
};

/// Two matrices that are inverse to one another would be one too many: rows of d(angle) /
/// d(position) [rad/m].
struct Arms {
  Vec3 angles{0.0, 0.0, 0.0};  ///< [rad] of the three thighs
  Mat3 slope{0.0};             ///< slope[column][row]: d angle(row) / d position(column)
};

/// None where the grip cannot be, or where an arm is stretched.
[[nodiscard]] std::optional<Arms> armsAt(const Vec3& position,
                                         const Geometry& geometry = {}) noexcept;

struct Grip {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m]
  int iterations = 0;
};

/// Newton's method from `near`, to 1e-12 m. Where that does not get there within kMostIterations,
/// the angles are approached in 16 steps with as many each; none if that fails too. Bounded work;
/// real-time safe.
[[nodiscard]] std::optional<Grip> gripAt(const Vec3& angles, const Vec3& near,
                                         const Geometry& geometry = {}) noexcept;
constexpr int kMostIterations = 20;

/// [m] A place from which gripAt() gets to every place of the workspace.
[[nodiscard]] inline Vec3 middle() noexcept { return {0.0, 0.0, 0.11}; }

/// Torques [Nm] at the thighs that the motors must take from the hand for it to feel `force` [N]:
/// the transpose of d(position) / d(angles), times the force. None where the arms are singular.
[[nodiscard]] std::optional<Vec3> torquesFor(const Vec3& force, const Arms& arms) noexcept;

}  // namespace palpate::devices::falcon
