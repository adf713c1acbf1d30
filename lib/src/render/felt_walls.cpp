#include "felt_walls.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "palpate/contact/planes.h"
#include "solver_limits.h"

namespace palpate {
namespace {

/// In units of the depth of the press: walls that meet farther away than this are felt one at a
/// time.
constexpr double kFarthestMeeting = 30.0;
constexpr int kMeetingSteps = 12;
/// A place counts as common to two walls if its distances from them add up to at most kMet times
/// that farthest distance. kFlattest is the smallest squared sine of the angle between them.
constexpr double kMet = 1e-6;
constexpr double kFlattest = 1e-3;
/// Relative to the way to a wall and to the coordinates: rounding.
constexpr double kNearest = 1e-12;
/// Depth of the press over a wall's feature size: up to kBentBelow the wall is felt with its
/// curvature, above kFlatAbove as a plane.
constexpr double kBentBelow = 0.25;
constexpr double kFlatAbove = 1.0;
/// The most leaves between the proxy and the meeting of two walls that are taken into account.
constexpr std::size_t kMostTurned = 24;

bool holds(const ContactSet& contact, LeafId leaf) noexcept {
  const auto walls = contact.walls();
  return std::any_of(walls.begin(), walls.end(),
                     [&](const WallContact& each) { return each.leaf == leaf; });
}

/// The point within `farthest` [m] of `x` where two walls meet, by Newton's steps towards both. A
/// wall that lies wholly behind another one, as a bone does under skin, does not bound the proxy's
/// region.
std::optional<Vec3> meetingOf(const Vec3& x, const HeldWall& a, const HeldWall& b,
                              double farthest) noexcept {
  FieldSample at_a{a.jet.value, a.jet.gradient, a.jet.in_band};
  FieldSample at_b{b.jet.value, b.jet.gradient, b.jet.in_band};
  Vec3 p = x;
  for (int i = 0; i < kMeetingSteps; ++i) {
    const double slope_a = glm::length(at_a.gradient);
    const double slope_b = glm::length(at_b.gradient);
    if (!at_a.in_band || !at_b.in_band || !(slope_a > 0.0) || !(slope_b > 0.0)) return std::nullopt;
    const Vec3 m = at_a.gradient / slope_a;
    const Vec3 n = at_b.gradient / slope_b;
    const double off_a = at_a.value / slope_a;
    const double off_b = at_b.value / slope_b;
    if (std::fabs(off_a) + std::fabs(off_b) <= kMet * farthest) return p;
    const double cosine = glm::dot(m, n);
    const double square = 1.0 - cosine * cosine;
    if (square < kFlattest) return std::nullopt;
    p -= ((off_a - cosine * off_b) * m + (off_b - cosine * off_a) * n) / square;
    if (!(glm::length(p - x) <= farthest)) return std::nullopt;
    at_a = a.field->sample(p);
    at_b = b.field->sample(p);
  }
  return std::nullopt;
}

/// At a tip the projection may find any normal, even one that points to `place` [m]: then the point
/// found is not the nearest one. Inside a wall whose field is an exact distance the field's value
/// reveals this.
bool isNearest(const LocalProjection& on, const Vec3& place) noexcept {
  if (on.count != 1) return true;
  const HeldWall& held = on.held[0];
  if (held.side > 0.0 || held.field->metric() != Metric::kExact) return true;
  const FieldSample there = held.field->sample(place);
  const double way = glm::length(place - on.at);
  return !there.in_band || way <= (1.0 + kNearest) * there.value + kNearest * glm::length(on.at);
}

}  // namespace

/// Whether the proxy's region may end at this facet. Only the place itself decides whether it does:
/// which regions touch in the scene was found by sampling.
bool FeltWalls::isWall(const Facet& facet) noexcept {
  return facet.isClosed() && facet.material >= 0;
}

/// Distinguishes walls of one material by what lies behind them, or by the solid whose shape is
/// smoothed.
int FeltWalls::ownOf(const Near& wall) const noexcept {
  const Material& own = material(wall.facet);
  const RegionId here = walker_.region();
  const bool is_sheet = wall.facet.beyond == here;
  if (own.composite.radius > 0.0 || (own.shading > 0.0 && is_sheet)) return 1 + wall.leaf;
  return own.shading > 0.0 ? -1 - std::max(here, wall.facet.beyond) : 0;
}

/// Whether a group already has a wall on the surface that was looked up last.
bool FeltWalls::isFeltAlready() const noexcept {
  for (std::size_t g = 0; g < count_; ++g) {
    for (std::size_t i = 0; i < group_[g].count; ++i) {
      if (seams_.isOnSurface(group_[g].wall[i].leaf)) return true;
    }
  }
  return false;
}

void FeltWalls::add(const Near& wall) noexcept {
  const int kind = kind_[static_cast<std::size_t>(wall.facet.material)];
  const int own = ownOf(wall);
  const bool shares = isShared(wall);
  std::size_t g = 0;
  if (shares) {
    has_seam_ = true;
    // A surface is felt once, however many layers end there.
    if (isFeltAlready()) return;
    g = count_;
  } else {
    while (g < count_ && (group_[g].shares || group_[g].kind != kind || group_[g].own != own)) {
      ++g;
    }
  }
  if (g == kMost) return;
  Group& group = group_[g];
  if (g == count_) {
    ++count_;
    group.kind = kind;
    group.own = own;
    group.shares = shares;
    group.count = 0;
  }
  if (group.count == kMaxProjectionWalls) return;
  group.held[group.count] = wall.held;
  group.wall[group.count++] = wall;
}

FeltLeaves FeltWalls::leaves() const noexcept {
  FeltLeaves out;
  for (std::size_t g = 0; g < count_; ++g) {
    for (std::size_t i = 0; i < group_[g].count; ++i) out.add(group_[g].wall[i].leaf);
  }
  return out;
}

bool FeltWalls::differ(const ContactSet& contact, double reach) noexcept {
  findGroups(contact, reach);
  if (count_ < 2) return false;
  for (std::size_t i = 0; i < count_; ++i) {
    setLaw(group_[i], smoothed_[i]);
    flatten(group_[i]);
  }
  return true;
}

/// Whether a wall bounds the region, or one that this leads to freely, at the place where it meets
/// the wall of the leaf `beside`. It does not where a third layer covers both, as skin covers a
/// bone and a ridge that crosses it.
bool FeltWalls::isWallAt(const Near& wall, LeafId beside, const Vec3& place) noexcept {
  std::array<LeafId, kMostTurned> turned{};
  std::size_t count = 0;
  bool are_too_many = false;
  walker_.forWithin(glm::length(place - walker_.position()), [&](LeafId id) {
    if (id == wall.leaf || id == beside) return;
    const Leaf& leaf = walker_.leaf(id);
    const double value = leaf.field->value(place);
    const double touched = limits::kTouch * limits::kOnSurface * leaf.feature * leaf.lipschitz;
    if (!(std::fabs(value) > touched) || (value < 0.0) == (walker_.side(id) < 0.0)) return;
    are_too_many = count == turned.size();
    if (!are_too_many) turned[count++] = id;
  });
  if (are_too_many) return true;
  return seams_.facetOf(wall.leaf, wall.held, place, {turned.data(), count}).isClosed();
}

void FeltWalls::findGroups(const ContactSet& contact, double reach) noexcept {
  count_ = 0;
  has_seam_ = false;
  seams_.clear();
  if (!may_differ_[walker_.region()]) return;
  // Usually nothing is near except the walls that hold the proxy, and what lies beneath them.
  bool is_alone = true;
  walker_.forWithin(reach, [&](LeafId id) {
    if (!holds(contact, id)) is_alone = false;
  });
  if (!is_alone || contact.count > 1) {
    // The hand is `reach` from the proxy, and at most as far from where walls of one kind would
    // hold the proxy: a seam between the two places is within twice that distance.
    walker_.forWithin(2.0 * reach, [&](LeafId id) { seams_.add(id); });
  }
  for (const WallContact& each : contact.walls()) add({each.leaf, each.facet, each.held});
  if (is_alone) return;
  // Trust the sides that the walker knows: the proxy may be slightly beyond a wall.
  if (!near_.look(reach, true)) return;
  const std::span<const NearWall> walls = near_.walls();
  // In the cell that is bounded by the walls that hold the proxy, all other bounding walls are felt
  // too.
  for (const NearCell& cell : near_.cells()) {
    const auto bounds = [&](const WallContact& each) {
      for (std::size_t i = 0; i < walls.size(); ++i) {
        if (walls[i].leaf != each.leaf) continue;
        return (((each.held.side < 0.0 ? cell.inside : cell.outside) >> i) & 1U) != 0;
      }
      return false;
    };
    const auto held = contact.walls();
    if (!std::all_of(held.begin(), held.end(), bounds)) continue;
    for (std::size_t i = 0; i < walls.size(); ++i) {
      const bool inside = ((cell.inside >> i) & 1U) != 0;
      if (!inside && ((cell.outside >> i) & 1U) == 0) continue;
      const LeafId leaf = walls[i].leaf;
      if (holds(contact, leaf) || !(walls[i].slope > 0.0)) continue;
      if (known_ != nullptr && !known_->has(leaf)) continue;
      if (walls[i].gap(inside) > reach) continue;
      Near near{leaf, {}, {}};
      near.held.field = walker_.leaf(leaf).field.get();
      near.held.side = inside ? -1.0 : 1.0;
      near.held.jet = walker_.jetHere(leaf);
      near.held.normal = inside ? -walls[i].normal : walls[i].normal;
      // The walker recognizes coplanar leaves as one wall only where it touches them.
      near.facet = seams_.isAlone(leaf, near.held)
                       ? walker_.facetAt(leaf)
                       : seams_.facetOf(leaf, near.held, footOn(near.held));
      if (isFeltAlready() || !isWall(near.facet)) continue;
      if (std::none_of(held.begin(), held.end(), [&](const WallContact& each) {
            const auto at =
                meetingOf(walker_.position(), each.held, near.held, kFarthestMeeting * reach);
            return at.has_value() && isWallAt(near, each.leaf, *at);
          })) {
        continue;
      }
      add(near);
    }
    break;
  }
}

/// If the hand is deep compared with a bulge's radius, the projected point would slide round the
/// bulge to its other side, and contact would be lost there. Within a ball or a cone each place has
/// one nearest point, and at a cone's tip there is no tangent plane.
void FeltWalls::flatten(Group& group) const noexcept {
  const double length = glm::length(press_);
  for (std::size_t i = 0; i < group.count; ++i) {
    const Leaf& leaf = walker_.leaf(group.wall[i].leaf);
    if (leaf.is_flat || (is_convex_[group.wall[i].leaf] && group.held[i].side < 0.0)) continue;
    const double way = leaf.feature * (kFlatAbove - kBentBelow);  // [m]
    const double q = std::min((length - kBentBelow * leaf.feature) / way, 1.0);
    if (!(q > 0.0)) continue;
    const double rise = 6.0 * q * (1.0 - q) / way;
    HeldWall& held = group.held[i];
    group.flat[i] = FlattenedWall(*held.field, held.jet, walker_.position(),
                                  q * q * (3.0 - 2.0 * q), (rise / length) * press_);
    held.field = &group.flat[i];
  }
}

/// The distance to the nearest point changes by each wall's change times the wall's multiplier.
SoftKinds::Change FeltWalls::change(std::size_t index, const LocalProjection& on) const noexcept {
  const Group& group = group_[index];
  Change out;
  Vec3 back(0.0);
  for (const HeldWall& held : on.walls()) {
    back += held.multiplier * held.normal;
    const double slope = glm::length(held.jet.gradient);
    const auto* const flat = std::find_if(
        group.flat.begin(), group.flat.begin() + static_cast<std::ptrdiff_t>(group.count),
        [&](const FlattenedWall& each) { return &each == held.field; });
    if (flat == group.flat.begin() + static_cast<std::ptrdiff_t>(group.count) || !(slope > 0.0))
      continue;
    const double by = held.multiplier * held.side / slope;
    out.by_proxy -= by * flat->byProxy(on.at);
    out.by_press -= by * flat->byPress(on.at);
  }
  const double length = glm::length(back);
  if (!(length > 0.0)) return {};
  out.by_proxy /= length;
  out.by_press /= length;
  return out;
}

/// Replaces the walls by their tangent planes at the proxy: for places where they fold, or their
/// fields end.
LocalProjection FeltWalls::ontoPlanes(const Group& group, const Vec3& place) const noexcept {
  LocalProjection out;
  std::array<Plane, kMaxProjectionWalls> planes{};
  const Vec3 x = walker_.position();
  for (std::size_t i = 0; i < group.count; ++i) {
    const HeldWall& held = group.held[i];
    const double slope = glm::length(held.jet.gradient);
    planes[i] = {held.normal,
                 slope > 0.0 ? std::max(0.0, held.side * held.jet.value / slope) : 0.0};
  }
  const PlaneSolution s = closestStep(place - x, {planes.data(), group.count});
  out.at = x + s.step;
  for (std::size_t k = 0; k < static_cast<std::size_t>(s.count); ++k) {
    out.held[k] = group.held[static_cast<std::size_t>(s.plane[k])];
    out.held[k].jet.hessian = Mat3(0.0);
    out.held[k].multiplier = s.multiplier[k];
  }
  out.count = static_cast<std::size_t>(s.count);
  out.settled = true;
  return out;
}

LocalProjection FeltWalls::nearest(std::size_t index, const Vec3& from,
                                   const Vec3& place) noexcept {
  const Group& group = group_[index];
  const std::span<const HeldWall> held(group.held.data(), group.count);
  LocalProjection on = projectLocally(from, place, held);
  if (on.settled && isNearest(on, place)) return on;
  // The place is at a tip, or so near one that the wall curves more than Newton's steps can follow.
  const LocalProjection cut = projectByCuts(walker_.position(), place, held);
  if (cut.settled || on.settled) return cut.settled ? cut : on;
  on = projectLocally(walker_.position(), place, held);
  return on.settled ? on : ontoPlanes(group, place);
}

}  // namespace palpate
