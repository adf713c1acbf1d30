#include <algorithm>
#include <array>
#include <cmath>

#include "proxy_solver.h"
#include "step_checks.h"

// The usual ticks: the proxy flies with the hand, or glides on one smooth wall with no other wall
// near. Gliding between two walls is in proxy_crease.cpp.

namespace palpate {
namespace {

/// Counts the leaves that it is called with, and keeps the last two.
struct Found {
  LeafId last = 0;
  LeafId before = 0;
  int count = 0;
  void operator()(LeafId leaf) noexcept {
    before = last;
    last = leaf;
    ++count;
  }
};

/// On a wall with equal curvature in all directions (a sphere or a plane): the step to its point
/// closest to a hand that is `pull` [m] away along the wall and `beyond` [m] behind it. `normal` is
/// the wall's normal towards the free side, `side` times the outward one. False where the two
/// curvatures differ, or where that point is not a minimum by more than kFirm.
bool ballStep(const Vec3& normal, double side, const Vec3& pull, double beyond, const Mat3& bend,
              double bend_square, Vec3& step) noexcept {
  const Vec3 by_normal = bend * normal;
  const double across = glm::dot(by_normal, normal);
  const double trace = bend[0][0] + bend[1][1] + bend[2][2] - across;
  // With principal curvatures a and b: a^2 + b^2, and its value (a + b)^2 / 2 if they were equal.
  const double square = bend_square - 2.0 * glm::dot(by_normal, by_normal) + across * across;
  const double even = 0.5 * trace * trace;
  if (std::fabs(square - even) > limits::kEven * even) return false;
  const double curvature = 0.5 * side * trace;
  const double left = 1.0 - curvature * beyond;
  if (!(left > limits::kFirm)) return false;
  const double pulled = glm::dot(pull, pull);
  // The hand's distance from the sphere's center, in units of the radius.
  const double far = std::sqrt(left * left + curvature * curvature * pulled);
  const double share = 1.0 / (far * (left + far));
  step = ((left + far) * share) * pull - (curvature * pulled * share) * normal;
  return true;
}

/// Newton's step in the plane with `normal`, for a hand whose component in the plane is `pull` [m]
/// away: solves (I - bend) s = pull there. False where the result is not a minimum by more than
/// kFirm.
bool newtonAlong(const Vec3& normal, const Vec3& pull, const Mat3& bend, Vec3& step) noexcept {
  Vec3 t1(0.0);
  Vec3 t2(0.0);
  tangentsOf(normal, t1, t2);
  const Vec3 b1 = bend * t1;
  const double a = 1.0 - glm::dot(t1, b1);
  const double b = -glm::dot(t2, b1);
  const double c = 1.0 - glm::dot(t2, bend * t2);
  const double det = a * c - b * b;
  // Both eigenvalues lie above det / trace.
  if (!(a + c > 0.0 && det > limits::kFirm * (a + c))) return false;
  const double p1 = glm::dot(t1, pull);
  const double p2 = glm::dot(t2, pull);
  const double share = 1.0 / det;
  step = t1 * ((c * p1 - b * p2) * share) + t2 * ((a * p2 - b * p1) * share);
  return true;
}

}  // namespace

/// The fast way to the resting place that the general method would find, for cases where it is
/// certain: no wall, one smooth wall, or two. Returns false if it is not certain; the general
/// method then goes on from where the proxy is.
bool ProxySolver::goQuickly(const Vec3& hip, FrictionState& friction) noexcept {
  if (walker_.isSealed()) return false;
  const Vec3 x = walker_.position();
  rest_ = restLength(x, hip - x);
  Found found;
  walker_.forWithin(rest_, found);
  if (found.count == 0) {
    friction.sticks = false;
    return walker_.move(hip, false) == CellWalker::Stop::kArrived;
  }
  if (found.count == 1) {
    if (glide(found.last, -1, hip, friction)) return true;
    return other_ >= 0 && glideBetween(found.last, static_cast<LeafId>(other_), hip, friction);
  }
  if (found.count != 2) return false;
  if (glideBetween(found.before, found.last, hip, friction)) return true;
  return other_ >= 0 &&
         glide(other_ == found.last ? found.before : found.last, other_, hip, friction);
}

/// Finds by Newton's method where the proxy rests on `id`, the only leaf near except `free`, which
/// does not hold it (-1: there is none). Returns false, and changes nothing, if the result is
/// uncertain; if the proxy meets another leaf on the way, other_ names it.
bool ProxySolver::glide(LeafId id, int free, const Vec3& hip, FrictionState& friction) noexcept {
  other_ = -1;
  const Vec3 x = walker_.position();
  const Leaf& leaf = walker_.leaf(id);
  Facet facet = walker_.facetAt(id);
  if (!isWallHere(leaf, facet)) return false;
  const Friction& rough = frictionOf(facet);
  const bool may_lag = !rough.static_ratio.isConstant() || rough.static_ratio.at(x) > 0.0;
  const bool slides_easily =
      may_lag && rough.static_ratio.range().least > rough.kinetic_ratio.range().most;
  FrictionState after{};
  after.sticks = friction.sticks;
  after.lean = friction.lean;
  Vec3 lag(0.0);
  const double side = walker_.side(id);
  const bool inside = side < 0.0;

  Vec3 y = x;
  FieldJet jet = walker_.jetHere(id);
  WallThere wall = wallOf(id, leaf, {jet.value, jet.gradient, jet.in_band});
  if (wall.gap(inside) < -wall.tolerance) return false;
  double bend_size = 0.0;
  for (int round = 0;; ++round) {
    if (round == limits::kGlides || !(wall.slope > 0.0)) return false;
    const double gap = wall.gap(inside);
    const double left = gap - limits::kRest * wall.tolerance;
    const double within = (limits::kOnWall - limits::kRest) * wall.tolerance;
    if (round == 0 && std::fabs(left) > within) return false;
    // If rounding has put the proxy behind the surface, bring it back to the free side now:
    // otherwise it would stay behind, however long it glides.
    const bool is_on = gap >= 0.0 && left <= within;
    const Mat3 bend = jet.hessian * (1.0 / wall.slope);
    const double bend_square = squareOf(bend);
    bend_size = std::sqrt(bend_square);
    if (bend_size * leaf.feature > limits::kFolds) return false;
    const Vec3 wish = hip - y;
    const Vec3 normal = side * wall.normal;
    const double sink = is_on ? 0.0 : left;
    const double along = glm::dot(normal, wish);
    const double multiplier = -sink - along;
    if (!(multiplier > rest_)) return false;
    Vec3 pull = wish - along * normal;
    if (may_lag) {
      FrictionRatios ratios;
      if (round > 0 && !after.sticks && slides_easily) {
        // The proxy goes on sliding: the map of the static ratio need not be read.
        ratios = {rough.static_ratio.range().least, rough.kinetic_ratio.at(y)};
      } else {
        ratios.take(rough, y);
      }
      const Vec3 rest = after.lean - glm::dot(after.lean, normal) * normal;
      lag = lagOf(ratios, pull, rest, -gap - along, round == 0, after);
      pull -= lag;
    }
    // The place is a minimum if the wall's curvature, times the hand's distance beyond it, is below
    // 1.
    const bool is_rest = is_on && glm::dot(pull, pull) <= rest_ * rest_;
    if (is_rest && multiplier * bend_size < 1.0 - limits::kFirm) break;
    Vec3 step(0.0);
    const bool is_ball = ballStep(normal, side, pull, multiplier, bend, bend_square, step);
    if (!is_ball && !newtonAlong(normal, pull, side * multiplier * bend, step)) return false;
    if (is_rest) break;

    step -= sink * normal;
    const Vec3 to = y + step;
    const double length = glm::length(step);
    const double way = y == x ? length : glm::length(to - x);
    const double turn = is_ball ? limits::kGlidesFar : limits::kTurnsMore;
    if (!isShortFor(leaf, bend_size, way, turn)) return false;
    jet = leaf.field->jet(to);
    const WallThere there = wallOf(id, leaf, {jet.value, jet.gradient, jet.in_band});
    const double meant = is_on ? gap : limits::kRest * wall.tolerance;
    if (!landedAsPromised(wall, there, bend_size, length, there.gap(inside) - meant)) return false;
    y = to;
    wall = there;
  }

  // The proxy stands off the surface; a hand between the two does not press.
  if (!(side * glm::dot(wall.normal, y - hip) - wall.gap(inside) > rest_)) return false;
  if (y != x) {
    const Vec3 far_before = hip - x;
    const Vec3 far_after = hip - y;
    if (glm::dot(far_after, far_after) > glm::dot(far_before, far_before)) return false;
    const double way = glm::length(y - x);
    if (!keepsOnChord(*leaf.field, x, y, side / wall.slope, bend_size, wall.tolerance))
      return false;
    if (free >= 0 && !isPassed(static_cast<LeafId>(free), y, way)) return false;
    std::array<LeafId, 2> known = {id, static_cast<LeafId>(free)};
    other_ = walker_.metOnWay({known.data(), free < 0 ? 1U : 2U}, y, way, rest_);
    if (other_ >= 0) {
      known[1] = static_cast<LeafId>(other_);
      if (free >= 0 || !isPassed(known[1], y, way)) return false;
      if (walker_.metOnWay(known, y, way, rest_) >= 0) return false;
    }
    walker_.jump(y, way);
    walker_.know(id, jet);
  }
  if (y != x && !isPlainWall(leaf, facet)) {
    // The facet may differ here: an opening or a hole may begin, or another force may open it.
    const int material = facet.material;
    facet = walker_.facetAt(id);
    if (!isWallHere(leaf, facet) || facet.material != material) return false;
  }
  friction = after;
  takeOnly(id, facet, wall, jet, hip - y);
  contact_.lag = lag;
  return true;
}

/// Whether the way of `length` [m] to `y` stays on the free side of the near leaf `id`, and ends
/// off its surface.
bool ProxySolver::isPassed(LeafId id, const Vec3& y, double length) noexcept {
  const Leaf& leaf = walker_.leaf(id);
  const double side = walker_.side(id);
  const FieldJet& jet = walker_.jetHere(id);
  const WallThere here = wallOf(id, leaf, {jet.value, jet.gradient, jet.in_band});
  if (leaf.is_between || !(here.slope > 0.0) || here.gap(side < 0.0) < -here.tolerance)
    return false;
  const double bend = sizeOf(jet.hessian) / here.slope;
  const double scale = side / here.slope;
  return bend * leaf.feature <= limits::kFolds && isShortFor(leaf, bend, length) &&
         scale * leaf.field->value(y) > limits::kTouch * here.tolerance + rest_ &&
         keepsOnChord(*leaf.field, walker_.position(), y, scale, bend, here.tolerance);
}

/// The contact with the one wall that holds the proxy at rest. The pressure is measured from the
/// wall's surface.
void ProxySolver::takeOnly(LeafId id, const Facet& facet, const WallThere& wall,
                           const FieldJet& jet, const Vec3& wish) noexcept {
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
