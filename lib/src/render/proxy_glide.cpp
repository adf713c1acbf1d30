#include <algorithm>
#include <cmath>

#include "proxy_solver.h"

// The usual tick: the proxy glides on one smooth wall, and nothing else is near.

namespace palpate {

namespace {

/// Counts leaves.
struct Found {
  LeafId last = 0;
  int count = 0;
  void operator()(LeafId leaf) noexcept {
    last = leaf;
    ++count;
  }
};

}  // namespace

/// Finds by Newton the same place of rest as the general way, for a fraction of its cost. False, and nothing is changed,
/// wherever it is not sure: then the general way looks at all there is.
bool ProxySolver::glide(const Vec3& hip, FrictionState& friction) noexcept {
  if (walker_.isSealed()) return false;
  const Vec3 x = walker_.position();
  rest_ = restLength(x, hip - x);
  Found found;
  walker_.forWithin(rest_, found);
  if (found.count != 1) return false;
  const LeafId id = found.last;
  const Leaf& leaf = walker_.leaf(id);
  if (leaf.is_between) return false;
  const Facet facet = walker_.facetAt(id);
  if (!facet.isClosed() || facet.opens || facet.varies || facet.kind == Facet::Kind::kInternal) {
    return false;
  }
  const double side = walker_.side(id);
  const bool inside = side < 0.0;

  Vec3 y = x;
  FieldJet jet = walker_.jetHere(id);
  NearWall wall = wallOf(id, leaf, {jet.value, jet.gradient, jet.in_band});
  if (wall.gap(inside) < -wall.tolerance) return false;
  for (int round = 0;; ++round) {
    if (round == limits::kGlides || !(wall.slope > 0.0)) return false;
    const double gap = wall.gap(inside);
    const double left = gap - limits::kRest * wall.tolerance;
    const bool is_on = std::fabs(left) <= (limits::kOnWall - limits::kRest) * wall.tolerance;
    if (round == 0 && !is_on) return false;
    wall.bend = jet.hessian * (1.0 / wall.slope);
    const double bend_size = sizeOf(wall.bend);
    if (bend_size * leaf.feature > limits::kFolds) return false;
    const Vec3 wish = hip - y;
    const Plane plane{side * wall.normal, is_on ? 0.0 : left};
    const double along = glm::dot(plane.normal, wish);
    const double multiplier = -plane.gap - along;
    if (!(multiplier > rest_)) return false;
    // The place is a minimum where the wall's curvature, times how far the hand is beyond it, stays below 1.
    const bool is_firm = multiplier * bend_size < 1.0 - limits::kFirm;
    const Vec3 plain = wish + multiplier * plane.normal;
    if (is_firm && is_on && glm::dot(plain, plain) <= rest_ * rest_) break;
    const PlaneSolution solution{plain, 1, {0}, {multiplier}};
    const CurvedStep curved = curvedStep(wish, {&plane, 1}, solution, side * multiplier * wall.bend,
                                         limits::kLeastEigenvalue);
    if (curved.lowest < limits::kFirm) return false;
    if (is_on && glm::dot(plain, plain) <= rest_ * rest_) break;

    const Vec3 to = y + curved.step;
    const double length = glm::length(curved.step);
    const double way = glm::length(to - x);
    if (bend_size * way > limits::kTurnsMore) return false;
    if (!leaf.is_flat && way > limits::kShareOfFeature * leaf.feature) return false;
    jet = leaf.field->jet(to);
    const NearWall there = wallOf(id, leaf, {jet.value, jet.gradient, jet.in_band});
    // A wall that is not the one its curvature promises has a crease on the way.
    const double turned = glm::length(there.normal - wall.normal);
    const double bent = bend_size * length;
    const double off =
        std::fabs(there.gap(inside) - (plane.gap + glm::dot(plane.normal, curved.step)));
    if (turned > 2.0 * bent + limits::kFirmTurn ||
        off > bent * length + limits::kNoise * wall.tolerance) {
      return false;
    }
    y = to;
    wall = there;
  }

  // A hand between the surface and the proxy, which stands off it, does not press.
  if (!(side * glm::dot(wall.normal, y - hip) - wall.gap(inside) > rest_)) return false;
  const double static_ratio =
      scene_.materials()[static_cast<std::size_t>(facet.material)].friction.static_ratio.at(y);
  if (static_ratio > 0.0) return false;
  if (y != x) {
    const Vec3 before = hip - x;
    const Vec3 after = hip - y;
    if (glm::dot(after, after) > glm::dot(before, before)) return false;
    const double turn = sizeOf(wall.bend) * glm::length(y - x);
    if (turn > limits::kTurnsMuch) {
      const double dip = limits::kDipByBend * turn * glm::length(y - x);
      const double middle = side * leaf.field->value(0.5 * (x + y));
      if (middle < -(dip + wall.tolerance) * wall.slope) return false;
    }
    found = {};
    walker_.forWithin(glm::length(y - x), found);
    if (found.count != 1) return false;
    walker_.glideTo(y, id, jet);
  }
  friction.sticks = false;
  friction.is_felt = false;
  takeOnly(id, facet, wall, jet, hip - y);
  return true;
}

/// The contact with one wall that holds the proxy at rest. How hard it is pressed is measured from its surface.
void ProxySolver::takeOnly(LeafId id, const Facet& facet, const NearWall& wall, const FieldJet& jet,
                           const Vec3& wish) noexcept {
  const double side = walker_.side(id);
  const double gap = wall.gap(side < 0.0);
  const Vec3 normal = side * wall.normal;
  const double along = glm::dot(normal, wish);
  WallContact& out = contact_.wall[0];
  out.leaf = id;
  out.facet = facet;
  out.held.field = walker_.leaf(id).field.get();
  out.held.side = side;
  out.held.jet = jet;
  out.held.normal = normal;
  out.held.multiplier = -gap - along;
  contact_.count = 1;
  contact_.lag = Vec3(0.0);
  contact_.snug = -gap * normal;
  contact_.left = wish - along * normal;
}

}  // namespace palpate
