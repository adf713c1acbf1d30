#pragma once
/// CellWalker: moves a point through sign cells and never past a closed facet. The point's
/// position, its side of every leaf, its region and the ports it passed are a PlaceState, which the
/// walker changes; all other members only save evaluations.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/contact/sweep.h"
#include "palpate/interior/near_cells.h"
#include "palpate/interior/port_machine.h"
#include "palpate/render/tick_state.h"
#include "palpate/scene/scene.h"
#include "solver_limits.h"

namespace palpate {

class CellWalker {
 public:
  enum class Stop : std::uint8_t {
    kArrived,  ///< at the target
    kBlocked,  ///< on a closed facet, see blockedBy()
    kCrossed,  ///< just through a facet (only if asked to stop there)
    kSpent,    ///< out of budget, at the last point known to be free
  };

  /// `state` must outlive the walker. Call place() or resume() first.
  CellWalker(const Scene& scene, PlaceState& state);

  /// Puts the point at `p` [m] as if it had always been there: its sides and region are computed at
  /// `p`.
  void place(const Vec3& p) noexcept;
  /// Puts the point where `other`'s point is, with the same sides.
  void standWith(const CellWalker& other) noexcept;
  /// Call this after the state was replaced: the walker goes on from that state.
  void resume() noexcept;
  /// While sealed, everything that leads out of the region is a wall.
  void seal(bool is_sealed) noexcept {
    is_sealed_ = is_sealed;
    ++state_;
  }
  [[nodiscard]] bool isSealed() const noexcept { return is_sealed_; }
  /// Starts a new tick: no events yet, full budgets.
  void beginTick() noexcept;

  [[nodiscard]] const Vec3& position() const noexcept { return here_.point; }
  [[nodiscard]] RegionId region() const noexcept { return here_.region; }
  [[nodiscard]] const PassedPorts& passed() const noexcept { return here_.passed; }
  [[nodiscard]] double side(LeafId leaf) const noexcept {
    return here_.sides.inside(leaf) ? -1.0 : 1.0;
  }
  [[nodiscard]] const Leaf& leaf(LeafId id) const noexcept { return leaves_[id]; }
  [[nodiscard]] double tolerance(LeafId leaf) const noexcept { return tolerance_[leaf]; }

  /// The leaf's jet at the point; computed once as long as the point stays there.
  [[nodiscard]] const FieldJet& jetHere(LeafId leaf) noexcept {
    Jet& known = jets_[leaf];
    if (known.stay != stay_) known = {leaves_[leaf].field->jet(here_.point), stay_};
    return known.jet;
  }

  /// Moves straight to `target` [m], through everything that is open; stops after a crossing if
  /// `stop_at_crossing`.
  Stop move(const Vec3& target, bool stop_at_crossing) noexcept;
  /// Moves to `target` [m] along the walls `held`: the solver found that the way stays on the sides
  /// `cell` of the `near` leaves. Other leaves change side on the way, in order. If that opens one
  /// of the walls, the walker stops, already on the far side of that leaf, and reports which leaf
  /// it was and at about which share of the way; otherwise it arrives.
  struct Slid {
    bool arrived = true;
    LeafId leaf = 0;
    double share = 1.0;
  };
  [[nodiscard]] Slid slideTo(const Vec3& target, const NearCell& cell, std::span<const LeafId> near,
                             std::span<const LeafId> held) noexcept;
  /// Moves to `x` [m], which slideTo() or the solver found to be free.
  void jump(const Vec3& x) noexcept { jump(x, glm::length(x - here_.point)); }
  /// The same, with the known `length` [m] of the way.
  void jump(const Vec3& x, double length) noexcept {
    travel_ += length;
    here_.point = x;
    ++stay_;
  }
  /// States that the jet of `leaf` at the point is `jet`, so that it is not computed again.
  void know(LeafId leaf, const FieldJet& jet) noexcept { jets_[leaf] = {jet, stay_}; }
  [[nodiscard]] LeafId blockedBy() const noexcept { return blocked_by_; }

  /// Calls f(leaf) for each leaf that the point is beyond, or whose surface may come within
  /// `radius` [m] (plus a few of its tolerances) of the point.
  template <typename F>
  void forWithin(double radius, F&& f) noexcept {
    refresh(radius);
    for (std::size_t k = 0; k < hot_count_; ++k) {
      const LeafId leaf = hot_[k];
      const double reach = travel_ + radius + touch(leaf);
      if (due_[leaf] > reach) continue;
      (void)measure(leaf);
      if (due_[leaf] <= reach) f(leaf);
    }
  }
  /// A leaf that a way of `length` [m] to `target` may meet, or that may be less than `rest` [m]
  /// from its end; -1 if there is none except those in `leaves`.
  [[nodiscard]] int metOnWay(std::span<const LeafId> leaves, const Vec3& target, double length,
                             double rest) noexcept;
  [[nodiscard]] const Signs& signs() const noexcept { return here_.sides; }

  /// The facet of `leaf` at the point, seen from the present cell.
  [[nodiscard]] Facet facetAt(LeafId leaf) noexcept;
  /// True if crossing both `a` and `b` at once, two leaves that meet at the point, leads to the
  /// point's own region again.
  [[nodiscard]] bool isSameAcross(LeafId a, LeafId b) noexcept;
  /// The facet of the coinciding leaves `surface` at a place [m] near the point that lies on the
  /// other side of the leaves `turned`. It is seen from the region there, if that is the point's
  /// own region or one that this leads to freely; otherwise the result is a facet that is not
  /// closed. Holes are not considered.
  [[nodiscard]] Facet facetAside(std::span<const LeafId> turned, std::span<const LeafId> surface,
                                 const Vec3& place) noexcept;
  /// Goes through the facet of `leaf` at the point, whatever it is; records the port, and a hole if
  /// the facet gave way to a `force` [N].
  void cross(LeafId leaf, const Facet& facet, double force = 0.0) noexcept;
  [[nodiscard]] const Punctures& punctures() const noexcept { return here_.punctures; }

  /// False if this tick has crossed as many facets as is permitted.
  [[nodiscard]] bool mayCross() const noexcept { return crossings_left_ > 0; }

  [[nodiscard]] std::uint8_t eventCount() const noexcept { return event_count_; }
  [[nodiscard]] const std::array<PortId, TickResult::kMaxEvents>& events() const noexcept {
    return events_;
  }
  /// The crossings of ports in this tick, in path order: one for each of events().
  [[nodiscard]] std::span<const PortCrossing> crossings() const noexcept {
    return {crossings_.data(), event_count_};
  }
  /// The regions that were entered in this tick, in path order.
  [[nodiscard]] std::span<RegionEntry> entries() noexcept {
    return {entries_.data(), entry_count_};
  }
  [[nodiscard]] std::span<const RegionEntry> entries() const noexcept {
    return {entries_.data(), entry_count_};
  }
  /// The leaf through whose facet the region was last entered; -1 if it was not entered.
  [[nodiscard]] int mouth() const noexcept { return here_.mouth; }

 private:
  /// [m] Within this distance of a leaf the point counts as touching it.
  [[nodiscard]] double touch(LeafId leaf) const noexcept {
    return limits::kTouch * limits::kOnSurface * leaves_[leaf].feature;
  }
  /// True if the leaf has no meaning here (Leaf::is_between).
  [[nodiscard]] bool isIdle(LeafId leaf) const noexcept {
    const Leaf& own = leaves_[leaf];
    return own.is_between && !(here_.sides.inside(own.ends[0]) && here_.sides.inside(own.ends[1]));
  }
  /// Changes to the other side of `leaf` within the region.
  void turn(LeafId leaf) noexcept;
  /// Changes the side of `leaf`, and the sides of the walls between it and another layer.
  void flip(LeafId leaf, Signs& signs) const noexcept;
  /// S of the leaf at the point; also updates up to which odometer reading it is out of reach.
  double measure(LeafId leaf) noexcept;
  /// S of the leaf at the point, computed once as long as the point stays there.
  double valueHere(LeafId leaf) noexcept {
    // If the jet was needed during the last slide, it will be needed again: compute all of it.
    if (stay_ - jets_[leaf].stay <= limits::kStaysOfSlide) return jetHere(leaf).value;
    Measured& known = measured_[leaf];
    if (known.stay != stay_) known = {leaves_[leaf].field->value(here_.point), stay_};
    return known.value;
  }
  /// Makes sure that every leaf that a motion of `length` could reach is in the hot list.
  void refresh(double length) noexcept;
  /// The region that contains the cell beyond_; only layers that use a crossed leaf are evaluated
  /// again.
  [[nodiscard]] RegionId regionBeyond() const noexcept;
  void updateHolding() noexcept;
  /// Collects the leaves that coincide with `leaf` at the point, which change side together with
  /// it.
  void gather(LeafId leaf) noexcept;
  [[nodiscard]] SweepSurface surfaceOf(LeafId leaf) const noexcept;
  /// [m] A lower bound of the distance to the surface of `leaf`, where the point is on its free
  /// side with the value `value` >= 0.
  [[nodiscard]] double reachOf(LeafId leaf, double value) const noexcept;
  /// sweep(), restricted to where the Lipschitz bound of the leaf holds.
  [[nodiscard]] SweepResult sweepLeaf(LeafId leaf, SweepSurface surface, const Vec3& a,
                                      const Vec3& b, double start, int budget) const noexcept;

  const Scene& scene_;
  std::span<const Leaf> leaves_;
  /// The box where a leaf's Lipschitz bound holds, if that is not all space.
  struct Domain {
    Box3 box;
    bool is_everywhere = true;
    bool holds_surface = true;  ///< the surface lies within it: there is nothing to meet beyond
  };
  std::vector<Domain> domain_;
  std::vector<bool> opens_;        ///< by leaf: it is part of the extent of a port
  std::vector<double> tolerance_;  ///< on |S|, by leaf: 1e-9 of the feature size, in units of S
  PlaceState& here_;
  Signs beyond_;                   ///< scratch of facetAt()
  Signs aside_;                    ///< scratch of facetAside()
  std::vector<RegionId> holding_;  ///< layers that contain the cell, innermost (last) first
  bool is_sealed_ = false;
  LeafId blocked_by_ = 0;
  std::uint8_t event_count_ = 0;
  std::array<PortId, TickResult::kMaxEvents> events_{};
  std::array<PortCrossing, TickResult::kMaxEvents> crossings_{};
  std::array<RegionEntry, limits::kCrossings> entries_{};
  std::size_t entry_count_ = 0;
  int crossings_left_ = 0;
  int evaluations_left_ = 0;

  // A leaf whose |S| was measured cannot be met before the point has traveled |S| / L: `due_` is
  // the odometer reading at which it could. The hot leaves are those whose boxes were near the
  // point when the list was made; all others are out of reach until the odometer reads cold_due_.
  double travel_ = 0.0;
  std::vector<double> due_;
  std::vector<LeafId> hot_;
  std::size_t hot_count_ = 0;
  double cold_due_ = 0.0;
  double smallest_horizon_ = kInfinity;  ///< [m]

  struct Measured {
    double value = 0.0;
    std::uint64_t stay = 0;
  };
  struct Jet {
    FieldJet jet;
    std::uint64_t stay = 0;
  };
  std::vector<Measured> measured_;                  ///< by leaf
  std::vector<Jet> jets_;                           ///< by leaf
  std::uint64_t stay_ = 1 + limits::kStaysOfSlide;  ///< counts the places where the point has been

  /// A facet that was looked up in the present state, valid until a crossing; if it varies from
  /// place to place, valid only while the point stays where it was.
  struct Known {
    Facet facet;
    std::uint32_t state = 0;
    std::uint64_t stay = 0;
  };
  std::vector<Known> known_;  ///< by leaf, where no other leaf coincides
  std::uint32_t state_ = 1;   ///< counts crossings and placements
  /// The last answer of isSameAcross(), valid until a crossing.
  struct KnownPair {
    LeafId a = 0;
    LeafId b = 0;
    std::uint32_t state = 0;
    bool is_same = false;
  };
  KnownPair known_pair_;

  std::array<LeafId, 40> crossing_{};  ///< scratch of gather() and facetAside()
  std::size_t crossing_count_ = 0;
};

}  // namespace palpate
