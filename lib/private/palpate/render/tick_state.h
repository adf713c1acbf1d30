#pragma once
/// TickState: all that one tick of a renderer leaves for the next, as the renderers use it. To the
/// outside it is a RendererState.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "palpate/contact/maxwell_branch.h"
#include "palpate/contact/paper_contact.h"
#include "palpate/interior/partition.h"
#include "palpate/interior/passed_ports.h"
#include "palpate/interior/punctures.h"
#include "palpate/render/force_guard.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/render/insertion.h"

namespace palpate {

/// Where the probe is: the proxy of the constraint renderer, the HIP of the paper's.
struct PlaceState {
  Vec3 point{0.0, 0.0, 0.0};  ///< [m]
  Signs sides;                ///< of every leaf: the side that the point counts as being on
  RegionId region = kOutside;
  int mouth = -1;  ///< leaf whose facet the region was last entered through; -1: it was not entered
  PassedPorts passed;
  Punctures punctures;
  std::uint32_t audited = 0;  ///< counts leaves evaluated although they were out of reach
};

/// The friction state carried from one tick to the next.
struct FrictionState {
  bool sticks = false;
  bool is_felt = false;  ///< some wall that holds the proxy has friction
  /// [m] how far the springs would pull the proxy along the walls to where they are softer
  Vec3 lean{0.0, 0.0, 0.0};
};

/// The Maxwell branch of the wall that is pressed most.
struct RelaxationState {
  MaxwellBranch branch;
  double depth = 0.0;          ///< [m] at the last tick
  int material = -1;           ///< of the wall pressed; -1: none
  RegionId region = kOutside;  ///< region that it is pressed from
};

/// How much of a region's content is felt behind the opening that led to it.
struct FadeState {
  RegionId region = kOutside;  ///< region felt at the last tick
  double share = 1.0;          ///< [-]
};

/// The contact of Algorithms I and II.
struct PaperTouch {
  bool holds = false;
  std::uint16_t layer = 0;  ///< index of the touched layer
  double side = 1.0;
  PaperContact contact;
};

/// The leaves whose walls the hand felt at the last tick; empty without contact.
struct FeltLeaves {
  static constexpr std::size_t kMost = 16;
  std::array<LeafId, kMost> leaf{};
  std::size_t count = 0;
  bool is_full = false;  ///< there were more: any leaf may have been felt

  void add(LeafId id) noexcept {
    if (has(id)) return;
    is_full = count == kMost;
    if (!is_full) leaf[count++] = id;
  }
  void clear() noexcept {
    count = 0;
    is_full = false;
  }
  [[nodiscard]] bool has(LeafId id) const noexcept {
    const auto* const end = leaf.begin() + static_cast<std::ptrdiff_t>(count);
    return is_full || std::find(leaf.begin(), end, id) != end;
  }
};

/// The energy that the walls stored against the hand at the last tick, for regions whose walls may
/// have different laws.
struct StoredState {
  FeltLeaves leaves;          ///< leaves of the walls that held the proxy; none: nothing was stored
  double energy = 0.0;        ///< [J]
  Vec3 push{0.0, 0.0, 0.0};   ///< [N] of the springs
  bool has_friction = false;  ///< some of these walls have friction
};

/// Energy that does not come from the hand, and the values needed to count it.
struct SourceState {
  Vec3 flow_push{0.0, 0.0, 0.0};  ///< [N] force of flows at the last tick
  double lattice_energy = 0.0;    ///< [J] potential of the lattice at the tip
  bool in_lattice = false;        ///< a lattice was felt at the last tick
  RegionId lattice_region = kOutside;
  std::uint32_t lattice_version = 0;
  FeltLeaves felt;
  StoredState stored;
  double work = 0.0;  ///< [J] done on the hand since the first tick
};

/// A value of fixed size, about 24 kB: copied in about a microsecond. Each part states what happens
/// when it is full. A scene that needs more leaves (Signs::kMaxLeaves) or counted ports
/// (PassedPorts::kCapacity) than there is room for is refused when it is compiled.
struct TickState {
  RendererKind kind = RendererKind::kConstraint;  ///< kind of the renderer that made it
  bool has_begun = false;                         ///< false: the next tick is a first one
  Vec3 hip{0.0, 0.0, 0.0};                        ///< [m] of the last good tick
  TickResult last;                                ///< of the last good tick
  PlaceState place;
  FrictionState friction;
  int pressed = -1;  ///< material of the wall that was pressed last in this contact; -1: none
  RelaxationState relaxation;
  FadeState fade;
  Insertion needle;
  PaperTouch paper;
  ForceGuard guard;  ///< it also holds the limits of the force
  SourceState source;

  /// This state as an opaque value for others to keep.
  [[nodiscard]] RendererState sealed() const noexcept;
  [[nodiscard]] static TickState of(const RendererState& sealed) noexcept;
};

static_assert(std::is_trivially_copyable_v<TickState>);

}  // namespace palpate
