#pragma once
/// Regions and ports as the loop uses them, identified by numbers. Ports are the openings in walls
/// and sheets.

#include <cstdint>
#include <string>
#include <vector>

#include "palpate/export.h"
#include "palpate/materials/material.h"

namespace palpate {

using RegionId =
    std::uint16_t;  ///< 0 is `outside`; layer i (from 0, outermost first) is region i + 1
using LeafId = std::uint16_t;  ///< a smooth field whose surface separates regions
using PortId = std::uint16_t;  ///< index into Scene::ports(), in the order of the scene file

/// The region that every point outside all layers belongs to.
inline constexpr RegionId kOutside = 0;

/// Which way a port lets the proxy through. `in` is from the first region named to the second.
enum class PortDirection : std::uint8_t { kBoth, kIn, kOut };

/// A port that must have been passed before, and how often.
struct PassedBefore {
  PortId port = 0;  ///< the port that must have been passed
  int times = 1;    ///< 1 or more

  /// `at_least` passes of port `before`; a PortId alone means one.
  PassedBefore(PortId before = 0, int at_least = 1) : port(before), times(at_least) {}
};

/// How the force at which a wall ruptures depends on the speed v >= 0 [m/s] of the hand into the
/// wall: the force at rest is multiplied by
///   1 + (ratio - 1) v / (v + speed).
/// A fast hand comes near to `ratio` times the force at rest, and is half way there at `speed`.
/// Mahvash and Dupont 2010 (10.1109/TBME.2009.2036856) found that the force and the deformation at
/// rupture approach a limit as insertion gets faster, at a speed proportional to the inverse of the
/// tissue's relaxation time. This is the simplest curve with both limits.
struct RuptureRate {
  double ratio = 1.0;  ///< [-] more than 0; 1: the speed does not matter
  double speed = 0.0;  ///< [m/s] 0 or more, more than 0 unless `ratio` is 1

  /// [-] Factor on the force at rest.
  [[nodiscard]] double share(double v) const noexcept {
    return v > 0.0 && ratio != 1.0 ? 1.0 + (ratio - 1.0) * v / (v + speed) : 1.0;
  }
};

/// One opening. Regions may be several on each side (globs). Immutable after set-up.
struct PALPATE_EXPORT Port {
  std::string name;            ///< as the scene states it; reports and traces show it
  std::vector<RegionId> from;  ///< the first of `between`, resolved; empty in a sheet
  std::vector<RegionId> to;    ///< the second of `between`, resolved; empty in a sheet
  /// the sheet of the scene that it opens, with one region on both sides; -1: it opens a wall
  int sheet = -1;
  std::vector<LeafId> on;  ///< open only on facets of these leaves; empty: on any facet
  int mask = -1;           ///< open only within this mask of the partition; -1: everywhere
  PortDirection direction = PortDirection::kBoth;  ///< which way the proxy may pass
  std::vector<PassedBefore> after;                 ///< ports that must have been passed before
  int slot = -1;  ///< index in PassedPorts, assigned by Passages; -1: no `after` names this port
  /// [N] elastic normal force that opens it; 0: always open. A map is read at the point touched;
  /// where the map is 0, the lightest touch opens
  Parameter opens_at;
  Parameter back;    ///< [N] the same for coming back
  RuptureRate rate;  ///< how `opens_at` and `back` depend on the speed that presses the wall
  double hole_radius = 0.0;  ///< [m] of the hole left when force opens the port; 0: no hole
  /// [N] Within such a hole the port opens at this force, in place of opens_at and back where these
  /// are larger. A map is read at the point where the wall gave way.
  Parameter reopens_at;
  /// [m] After force has opened the port, it opens by force again only when the proxy has been this
  /// far from that point, or the hand is this far beyond the wall; 0: at once.
  double rearm = 0.0;

  /// True if going from `a` to `b` is the way in: from the first region named to the second.
  [[nodiscard]] bool leadsInward(RegionId a, RegionId b) const noexcept;

  /// True if going from `a` to `b`, which the port joins, counts as inward. Like leadsInward(), but
  /// where globs make both directions inward, only the direction towards the later layer counts, so
  /// that the way back counts as outward.
  [[nodiscard]] bool countsInward(RegionId a, RegionId b) const noexcept {
    return leadsInward(a, b) && (a < b || !leadsInward(b, a));
  }

  /// True if the port joins `a` to `b` in this direction of travel.
  [[nodiscard]] bool leads(RegionId a, RegionId b) const noexcept;
};

}  // namespace palpate
