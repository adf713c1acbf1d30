#pragma once
/// One tick of a renderer: what comes in from the device, and what it came to.

#include <array>
#include <cstdint>

#include "palpate/core/math.h"
#include "palpate/interior/port.h"

namespace palpate {

/// What the device says at one tick.
struct HipState {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world] the haptic interface point P
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s, world] by whatever estimator the caller names
  double dt = 1e-3;              ///< [s] since the last tick; for limits, and what relaxes in time
};

/// How the proxy went through a port.
struct PortCrossing {
  enum class How : std::uint8_t {
    kOpen,      ///< the port stood open
    kPuncture,  ///< its wall gave way to the force; a port that makes holes has a new one here
    kHole,      ///< by a hole made before, at its reopening force
  };
  PortId port = 0;
  RegionId from = kOutside;
  RegionId to = kOutside;
  How how = How::kOpen;
  Vec3 point{0.0, 0.0, 0.0};  ///< [m, world] where the surface was crossed
  Vec3 normal{0.0, 0.0,
              0.0};    ///< [-, world] of the surface there, back to where the proxy came from; zero
                       ///< where the surface has none
  double force = 0.0;  ///< [N] elastic normal force that it gave way to; 0 where it stood open
};

/// How the proxy got from one region into the next: through a port, or across a wall that is absent.
struct RegionEntry {
  RegionId from = kOutside;
  RegionId to = kOutside;
  int port = -1;              ///< PortId; -1: an absent wall
  Vec3 point{0.0, 0.0, 0.0};  ///< [m, world] of the wall, where it was crossed
  Vec3 normal{0.0, 0.0,
              0.0};  ///< [-, world] of the wall there, back to `from`; zero where it has none
  double force =
      0.0;  ///< [N] elastic normal force that the wall gave way to; 0 where none was needed
  double cut =
      0.0;  ///< [N] what the content of `from` took to be cut through to there; 0 without a needle
  double hole_radius = 0.0;  ///< [m] Port::hole_radius
};

/// What one tick came to.
struct TickResult {
  /// Crossings that one tick can make: what would cross more often goes on in the next tick.
  static constexpr std::size_t kMaxEvents = 32;
  static_assert(kMaxEvents <= 255, "event_count counts them");

  Vec3 force{0.0, 0.0, 0.0};  ///< [N, world] on the hand; always finite
  Vec3 proxy{0.0, 0.0, 0.0};  ///< [m, world] the tip held in its region
  RegionId region = kOutside;
  bool contact = false;  ///< a closed wall is pressed
  /// The proxy rests where it is closest to the hand, within the stated tolerances (the paper's renderer: always true);
  /// false: on its way there, at a point that is allowed and no further from the hand than the last one, out of budget.
  bool settled = true;
  std::uint8_t event_count = 0;  ///< crossings of this tick that passed a port, in path order
  std::array<PortId, kMaxEvents> events{};
};

}  // namespace palpate
