#include "cell_walker.h"

#include <algorithm>
#include <cmath>

#include "palpate/contact/sweep.h"
#include "palpate/interior/partition.h"
#include "solver_limits.h"

namespace palpate {
CellWalker::CellWalker(const Scene& scene, PlaceState& state)
    : scene_(scene),
      leaves_(scene.partition().leaves()),
      domain_(leaves_.size()),
      opens_(leaves_.size(), false),
      tolerance_(leaves_.size()),
      here_(state),
      beyond_(leaves_.size()),
      aside_(leaves_.size()),
      due_(leaves_.size()),
      hot_(leaves_.size()),
      measured_(leaves_.size()),
      jets_(leaves_.size()),
      known_(leaves_.size()) {
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    tolerance_[i] = limits::kOnSurface * leaves_[i].feature * leaves_[i].lipschitz;
    const Box3 box = leaves_[i].field->lipschitzDomain();
    const Box3 bounds = leaves_[i].field->bounds();
    domain_[i] = {box, box.lo == Vec3(-kInfinity) && box.hi == Vec3(kInfinity),
                  bounds.isEmpty() || (box.contains(bounds.lo) && box.contains(bounds.hi))};
    smallest_horizon_ = std::min(smallest_horizon_, limits::kHorizonShare * leaves_[i].feature);
  }
  for (const Port& port : scene.ports()) {
    if (port.mask < 0) continue;
    for (const SideStep& step :
         scene.partition().maskSides(static_cast<std::size_t>(port.mask), true)) {
      for (std::size_t i = 0; i < step.count; ++i) opens_[step.first + i] = true;
    }
  }
  holding_.reserve(scene.regions().size());
}

void CellWalker::place(const Vec3& p) noexcept {
  here_.point = p;
  if (here_.sides.size() != leaves_.size()) here_.sides = Signs(leaves_.size());
  scene_.partition().signsAt(p, here_.sides);
  resume();
  here_.region = holding_.empty() ? kOutside : holding_.front();
  here_.mouth = -1;
}

void CellWalker::standWith(const CellWalker& other) noexcept {
  here_.point = other.here_.point;
  here_.sides.assign(other.here_.sides);
  here_.region = other.here_.region;
  here_.mouth = -1;
  resume();
}

void CellWalker::resume() noexcept {
  // Advance the counter so far that no leaf's jet counts as asked for during the last slide.
  stay_ += limits::kStaysOfSlide + 1;
  ++state_;
  travel_ = 0.0;
  cold_due_ = 0.0;
  hot_count_ = 0;
  holding_.clear();
  for (std::size_t i = scene_.regions().size() - 1; i > 0; --i) {
    const auto region = static_cast<RegionId>(i);
    if (scene_.partition().layerHolds(region, here_.sides)) holding_.push_back(region);
  }
}

void CellWalker::beginTick() noexcept {
  event_count_ = 0;
  entry_count_ = 0;
  here_.punctures.visit(here_.point);
  crossings_left_ = limits::kCrossings;
  evaluations_left_ = limits::kEvaluationsPerTick;
  // The odometer restarts now and then, so that its rounding stays below every tolerance.
  if (travel_ > 1.0) {
    travel_ = 0.0;
    cold_due_ = 0.0;
  }
  // One leaf a tick is evaluated even if it cannot have been reached: a field whose Lipschitz bound
  // is false may have let the point through, and with a hand at rest nothing else would notice.
  if (hot_count_ == 0) return;
  const LeafId leaf = hot_[here_.audited++ % hot_count_];
  if (due_[leaf] > travel_) (void)measure(leaf);
}

double CellWalker::measure(LeafId leaf) noexcept {
  const double value = valueHere(leaf);
  // The point may be beyond a surface that was never crossed (if a field's Lipschitz bound is
  // false). Then the leaf counts as within reach, so that the point is brought back.
  due_[leaf] = travel_ + reachOf(leaf, std::max(0.0, side(leaf) * value));
  return value;
}

void CellWalker::refresh(double length) noexcept {
  if (travel_ + length < cold_due_) return;
  const double horizon = std::max(limits::kHorizon * length, smallest_horizon_);
  hot_count_ = 0;
  scene_.partition().tree().visit(here_.point, horizon, [&](std::uint32_t item) {
    const auto leaf = static_cast<LeafId>(item);
    due_[leaf] = travel_;
    hot_[hot_count_++] = leaf;
  });
  cold_due_ = travel_ + horizon;
}

int CellWalker::metOnWay(std::span<const LeafId> leaves, const Vec3& target, double length,
                         double rest) noexcept {
  refresh(length);
  for (std::size_t k = 0; k < hot_count_; ++k) {
    const LeafId other = hot_[k];
    if (std::find(leaves.begin(), leaves.end(), other) != leaves.end()) continue;
    const double reach = travel_ + length + touch(other);
    if (due_[other] > reach) continue;
    const double here = side(other) * measure(other);
    if (due_[other] > reach) continue;
    if (!domain_[other].is_everywhere) return other;
    // The way misses the leaf if both ends are so far from it that no point between them can be on
    // it.
    const double there = side(other) * leaves_[other].field->value(target);
    const double bound = leaves_[other].lipschitz;
    if (!(there > bound * (touch(other) + rest) &&
          here + there > bound * (length + touch(other)))) {
      return other;
    }
  }
  return -1;
}

CellWalker::Stop CellWalker::move(const Vec3& target, bool stop_at_crossing) noexcept {
  for (;;) {
    const double length = glm::length(target - here_.point);
    if (!(length > 0.0)) return Stop::kArrived;
    refresh(length);
    double nearest = 1.0;
    bool hit = false;
    bool unsure = false;
    bool is_second = false;
    LeafId hit_leaf = 0;
    // A sweep ignores a short passage in and out again. If another leaf stops the motion inside
    // such a passage, it is a hit after all: after every hit, all leaves are swept once more up to
    // the new stop.
    for (bool again = true; again;) {
      again = false;
      for (std::size_t k = 0; k < hot_count_; ++k) {
        const LeafId leaf = hot_[k];
        if (due_[leaf] > travel_ + nearest * length) continue;
        if (isIdle(leaf)) continue;
        const Vec3 end = nearest < 1.0 ? here_.point + nearest * (target - here_.point) : target;
        if (is_second) {
          if (leaf == hit_leaf ||
              side(leaf) * leaves_[leaf].field->value(end) >= -tolerance_[leaf]) {
            continue;
          }
        }
        const double start = side(leaf) * measure(leaf);
        const int budget = std::min(limits::kEvaluationsPerSweep, evaluations_left_);
        if (budget <= 8) return Stop::kSpent;
        const SweepResult result =
            sweepLeaf(leaf, surfaceOf(leaf), here_.point, end, start, budget);
        if (result.kind == SweepResult::Kind::kFree) continue;
        evaluations_left_ -= 8;
        nearest *= result.at;
        hit = result.kind == SweepResult::Kind::kHit;
        unsure = !hit;
        if (unsure) evaluations_left_ -= budget;
        hit_leaf = leaf;
        again = hot_count_ > 1 && nearest > 0.0;
      }
      is_second = true;
    }
    if (!hit && !unsure) {
      jump(target, length);
      return Stop::kArrived;
    }
    jump(here_.point + nearest * (target - here_.point), nearest * length);
    if (unsure) return Stop::kSpent;
    const Facet facet = facetAt(hit_leaf);
    if (facet.isClosed()) {
      blocked_by_ = hit_leaf;
      return Stop::kBlocked;
    }
    if (crossings_left_ <= 0) return Stop::kSpent;
    cross(hit_leaf, facet);
    if (stop_at_crossing) return Stop::kCrossed;
  }
}

double CellWalker::reachOf(LeafId leaf, double value) const noexcept {
  const double bound = value / leaves_[leaf].lipschitz;
  const Domain& domain = domain_[leaf];
  if (domain.is_everywhere) return bound;
  if (domain.box.contains(here_.point)) {
    if (domain.holds_surface) return bound;
    const Vec3 room = glm::min(here_.point - domain.box.lo, domain.box.hi - here_.point);
    return std::min(bound, std::min({room.x, room.y, room.z}));
  }
  return domain.holds_surface ? leaves_[leaf].field->bounds().distanceTo(here_.point) : 0.0;
}

SweepResult CellWalker::sweepLeaf(LeafId leaf, SweepSurface surface, const Vec3& a, const Vec3& b,
                                  double start, int budget) const noexcept {
  const Domain& domain = domain_[leaf];
  if (domain.is_everywhere || (domain.box.contains(a) && domain.box.contains(b))) {
    return sweep(surface, a, b, start, budget);
  }
  if (!domain.holds_surface) {
    // The bound does not hold out there; the slopes at both ends estimate how steep the field may
    // be between them.
    for (const Vec3& end : {a, b}) {
      const double slope = glm::length(surface.field->sample(end).gradient);
      surface.lipschitz = std::max(surface.lipschitz, 2.0 * slope);
    }
    return sweep(surface, a, b, start, budget);
  }
  // Only the part within the box can meet the surface.
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double by = b[axis] - a[axis];
    const double lo = domain.box.lo[axis] - a[axis];
    const double hi = domain.box.hi[axis] - a[axis];
    if (by == 0.0) {
      if (lo > 0.0 || hi < 0.0) return {};
      continue;
    }
    enter = std::max(enter, std::min(lo / by, hi / by));
    leave = std::min(leave, std::max(lo / by, hi / by));
  }
  if (!(enter < leave)) return {};
  const Vec3 from = a + enter * (b - a);
  const Vec3 to = a + leave * (b - a);
  if (enter > 0.0) start = surface.side * surface.field->value(from) + surface.allowance;
  SweepResult out = sweep(surface, from, to, start, budget);
  out.at = out.kind == SweepResult::Kind::kFree ? 1.0 : enter + out.at * (leave - enter);
  return out;
}

SweepSurface CellWalker::surfaceOf(LeafId leaf) const noexcept {
  SweepSurface surface;
  surface.field = leaves_[leaf].field.get();
  surface.side = side(leaf);
  surface.lipschitz = leaves_[leaf].lipschitz;
  surface.tolerance = tolerance_[leaf];
  surface.graze = limits::kGraze * leaves_[leaf].feature;
  surface.is_flat = leaves_[leaf].is_flat;
  return surface;
}

void CellWalker::turn(LeafId leaf) noexcept {
  crossing_[0] = leaf;
  crossing_count_ = 1;
  flip(leaf, here_.sides);
  updateHolding();
  ++state_;
}

CellWalker::Slid CellWalker::slideTo(const Vec3& target, const NearCell& cell,
                                     std::span<const LeafId> near,
                                     std::span<const LeafId> held) noexcept {
  struct Change {
    LeafId leaf = 0;
    double at = 0.0;
  };
  std::array<Change, NearCells::kMaxNear> changes{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const LeafId leaf = near[i];
    if (isIdle(leaf)) continue;
    const std::uint32_t bit = std::uint32_t{1} << i;
    if (((cell.inside | cell.outside) & bit) != 0) {
      if (here_.sides.inside(leaf) != ((cell.inside & bit) != 0)) changes[count++] = {leaf, 0.0};
      continue;
    }
    const double before = std::max(0.0, side(leaf) * valueHere(leaf));
    const double after = side(leaf) * leaves_[leaf].field->value(target);
    if (opens_[leaf] && !held.empty()) {
      // An opening may be narrower than the way is long, so the ends of the way do not show it.
      const int budget = std::min(limits::kEvaluationsPerSweep, evaluations_left_);
      const SweepResult swept =
          sweepLeaf(leaf, surfaceOf(leaf), here_.point, target, before, budget);
      if (swept.kind != SweepResult::Kind::kFree) changes[count++] = {leaf, swept.at};
    } else if (after < -tolerance_[leaf]) {
      changes[count++] = {leaf, before / (before - after)};
    }
  }
  std::sort(changes.begin(), changes.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Change& a, const Change& b) { return a.at < b.at; });
  for (std::size_t i = 0; i < count; ++i) {
    turn(changes[i].leaf);
    for (const LeafId wall : held) {
      if (!facetAt(wall).isClosed()) return {false, changes[i].leaf, changes[i].at};
    }
  }
  jump(target);
  for (std::size_t i = 0; i < count; ++i) {
    const LeafId leaf = changes[i].leaf;
    if (opens_[leaf] && side(leaf) * valueHere(leaf) < -tolerance_[leaf]) turn(leaf);
  }
  return {};
}

}  // namespace palpate
