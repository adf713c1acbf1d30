#include <algorithm>
#include <cmath>
#include <utility>

#include "feel.h"

// The force of the walls that hold the proxy.

namespace palpate {

namespace {

/// In units of the hand's way in the tick: if the proxy moves farther than this, it does not follow
/// the hand but jumps away from the place that held it.
constexpr double kLeap = 4.0;
/// Shortly before the proxy leaves a bulge it runs ahead of the hand, and the planes of its walls
/// turn with it. The force of this turning is limited to this share [-] of the force of the
/// springs. The part that is cut off is counted as a source.
constexpr double kMostTurn = 0.5;

/// A branch with the same parameters is handed on from wall to wall, since the tissue continues
/// behind them.
bool relaxAlike(const Maxwell& a, const Maxwell& b) noexcept {
  return a.time == b.time && a.stiffness == b.stiffness;
}

}  // namespace

/// The Maxwell branch of the wall that is pressed most: stretched by the depth that the hand
/// presses it now.
void Feel::relax(const ContactSet& c, const HipState& hip) noexcept {
  RelaxationState& branch = state_.relaxation;
  if (c.count == 0) {
    // If the proxy ran out of budget on its way to the hand, the walls of the last tick still hold
    // it.
    if (walker_.position() == hip.position) branch = {};
    return;
  }
  std::size_t most = 0;
  for (std::size_t i = 1; i < c.count; ++i) {
    if (c.wall[i].held.multiplier > c.wall[most].held.multiplier) most = i;
  }
  const Facet& facet = c.wall[most].facet;
  const Material& wall = wallMaterial(facet);
  const bool has_branch = wall.maxwell.time > 0.0;
  const double depth = has_branch ? c.load() : 0.0;
  const bool goes_on =
      branch.region == walker_.region() && branch.material >= 0 &&
      relaxAlike(scene_.materials()[static_cast<std::size_t>(branch.material)].maxwell,
                 wall.maxwell);
  // If the wall is pressed from free space, the branch is stretched by the whole depth. If the
  // proxy was handed on from another wall, the hand's motion of this tick did not press this wall:
  // it counts as relaxed.
  const double before = goes_on || branch.material < 0 ? branch.depth : depth;
  if (!goes_on) branch.branch.reset();
  branch.material = facet.material;
  branch.region = walker_.region();
  branch.depth = depth;
  if (!has_branch) return;
  branch.branch.step(depth - before, hip.dt, wall.maxwell.time);
  const double stiffness = wall.maxwell.stiffness.at(walker_.position());
  // The branch slackens rather than make the force of the wall negative.
  if (stiffness > 0.0) branch.branch.keepAbove(-springOf(c.wall[most]).force(depth) / stiffness);
}

/// Walls of one kind: one spring is stretched by the whole way from the hand to the proxy,
/// whichever walls hold the proxy.
Feel::SpringForce Feel::evenForce(const ContactSet& c, const Vec3& apart) noexcept {
  SpringForce out;
  Vec3 by_press(0.0);
  double secant = 0.0;
  if (walls_.isPlain(c.wall[0].facet) && !walls_.hasSeam()) {
    secant = wallMaterial(c.wall[0].facet).stiffness.at(walker_.position());
    out.energy = 0.5 * secant * glm::dot(apart, apart);
  } else {
    const SharedWalls felt = walls_.shared(c.wall[0], walker_.position());
    const double length = glm::length(apart);
    out.varies = !felt.isEven();
    if (out.varies) {
      by_press = felt.byPress(length);
      out.rise = felt.rise(length) + by_press;
    }
    secant = felt.force(length) / length;
    out.energy = felt.energy(length);
    if (!felt.isStraight()) {
      out.stiffness = secant;
      out.force = out.stiffness * apart + by_press;
      return out;
    }
  }
  double total = 0.0;
  for (const WallContact& each : c.walls()) {
    out.force += secant * each.held.multiplier * each.held.normal;
    out.stiffness += secant * each.held.multiplier;
    total += each.held.multiplier;
  }
  out.stiffness /= total;
  // Subtract the part of the displacement that is not held by the walls, but by friction, or
  // because the proxy has not arrived yet.
  out.held = out.stiffness * c.left - by_press;
  return out;
}

/// Walls of several kinds. Where friction holds the proxy, the walls are pressed as if the whole
/// displacement were perpendicular to them; the force along the walls is the corresponding share.
/// So the stored energy depends on the displacement alone, as long as the proxy stays where it is.
Feel::SpringForce Feel::mixedForce(const ContactSet& c, const Vec3& apart,
                                   const Vec3& outward) noexcept {
  const Vec3 x = walker_.position() + c.snug;
  SpringForce out;
  const double length = glm::length(apart);
  const double across = glm::length(outward);
  if (!state_.friction.is_felt || !(across > 0.0)) {
    const SeriesForce series = seriesForce(x, x - apart, walls_.stop(), walls_);
    out.energy = series.energy;
    out.force = series.force + series.by_press;
    out.rise = series.rise + series.by_press;
    out.varies = series.varies;
    out.turn = series.turn;
    return out;
  }
  const Vec3 u = outward / across;
  const SeriesForce series = seriesForce(x, x - length * u, walls_.stop(), walls_);
  out.energy = series.energy;
  const Vec3& pressed = series.force;
  const Vec3 along = c.along(pressed);
  const double straight = glm::dot(pressed, u);
  const double lag = glm::dot(c.left, c.left);
  out.stiffness = straight / length;
  out.rise = series.rise + series.by_press - along;
  out.turn = series.turn;
  out.force = (length / across) * (pressed - along) - (straight * lag / (across * length)) * u -
              out.stiffness * c.left + series.by_press;
  return out;
}

double Feel::stored(const ContactSet& c, const Vec3& hip) noexcept {
  if (c.count == 0) return 0.0;
  const Vec3 x = walker_.position() + c.snug;
  const Vec3 press = x - hip;
  walls_.press(press);
  if (walls_.differ(c, glm::length(press))) {
    return seriesForce(x, hip, walls_.stop(), walls_).energy;
  }
  // Not the energy of the spring alone: texture and shading contribute to it.
  return walls_.shared(c.wall[0], walker_.position()).energy(c.load());
}

/// A wall behind a softer one is felt from the edge where the two meet. When the proxy comes to
/// that edge, the wall begins to push all at once, with the depth that the hand has by then. The
/// energy that this adds does not come from the hand, and is counted as a source. Returns true if
/// there was such a wall.
bool Feel::countSudden(const ContactSet& c, const Vec3& hip) noexcept {
  SourceState& source = state_.source;
  const FeltLeaves now = walls_.leaves();
  const FeltLeaves before = std::exchange(source.felt, now);
  const auto* const end = now.leaf.begin() + static_cast<std::ptrdiff_t>(now.count);
  const bool is_sudden =
      before.count > 0 && std::any_of(now.leaf.begin(), end, [&](LeafId id) {
        return !before.has(id) &&
               std::none_of(c.walls().begin(), c.walls().end(),
                            [&](const WallContact& each) { return each.leaf == id; });
      });
  if (!is_sudden) return false;
  const double all = stored(c, hip);
  walls_.findOnly(&before);
  source.work += std::max(0.0, all - stored(c, hip));
  walls_.findOnly(nullptr);
  return true;
}

/// When friction lets go, or the place that held the proxy ceases to be a minimum, the proxy jumps,
/// perhaps to stiffer walls, into which the hand is already deep. The energy stored there, beyond
/// the energy stored before and the work of the hand in this tick, does not come from the hand. It
/// is counted as a source, except the part `counted` [J] that already is. Between walls of equal
/// stiffness a jump only loses energy, since it brings the proxy closer.
void Feel::countLeap(const ContactSet& c, const HipState& hip, const Elastic& elastic,
                     double counted) noexcept {
  StoredState& last = state_.source.stored;
  if (!walls_.mayDiffer()) {
    last.leaves.clear();
    return;
  }
  StoredState now;
  for (const WallContact& each : c.walls()) now.leaves.add(each.leaf);
  now.energy = elastic.energy;
  now.push = elastic.push;
  now.has_friction = state_.friction.is_felt;
  const Vec3 way = hip.position - state_.hip;
  const auto& held = now.leaves;
  const bool is_same =
      held.count == last.leaves.count &&
      std::all_of(held.leaf.begin(), held.leaf.begin() + static_cast<std::ptrdiff_t>(held.count),
                  [&](LeafId id) { return last.leaves.has(id); });
  if (last.leaves.count > 0) {
    const Vec3 leap = walker_.position() + c.snug - state_.last.proxy;
    const bool leaps = glm::dot(leap, leap) > kLeap * kLeap * glm::dot(way, way);
    const bool lets_go = !is_same && (last.has_friction || now.has_friction || leaps);
    if (lets_go || elastic.is_held_back) {
      const double done = -0.5 * glm::dot(last.push + now.push, way);
      state_.source.work += std::max(0.0, now.energy - last.energy - done - counted);
    }
  }
  last = now;
}

/// The force of the springs between the proxy and the hand. If all walls have one stiffness, it is
/// that stiffness times the way from the hand to the proxy, whichever walls were found.
Vec3 Feel::walls(const ContactSet& c, const HipState& hip) noexcept {
  relax(c, hip);
  const Vec3& x = walker_.position();
  const Vec3 apart = x - hip.position;
  state_.friction.lean = Vec3(0.0);
  if (apart == Vec3(0.0) || c.count == 0) {
    state_.source.felt.clear();
    state_.source.stored.leaves.clear();
  }
  if (apart == Vec3(0.0)) {
    state_.pressed = -1;
    return Vec3(0.0);
  }
  if (c.count == 0) {
    // The proxy ran out of budget on its way: the wall that held it last still pulls.
    if (state_.pressed < 0) return Vec3(0.0);
    return scene_.materials()[static_cast<std::size_t>(state_.pressed)].stiffness.at(x) * apart;
  }
  state_.pressed = c.wall[0].facet.material;
  double total = 0.0;
  Vec3 outward(0.0);
  for (const WallContact& each : c.walls()) {
    outward += each.held.multiplier * each.held.normal;
    total += each.held.multiplier;
  }
  const Vec3 n = unitOr(outward, Vec3(0.0));
  // Measured from the walls' surfaces; the proxy stands off them a little.
  const Vec3 press = apart + c.snug;
  walls_.press(press);
  bool differ = walls_.differ(c, glm::length(press));
  const double sources = state_.source.work;
  if (countSudden(c, hip.position)) differ = walls_.differ(c, glm::length(press));
  const SpringForce springs = differ ? mixedForce(c, press, outward) : evenForce(c, press);
  const double counted = state_.source.work - sources;
  double damping = 0.0;
  for (const WallContact& each : c.walls()) {
    damping += wallMaterial(each.facet).damping.at(x) * each.held.multiplier;
  }
  damping /= total;
  Vec3 elastic = springs.force - springs.held;
  Vec3 relaxing(0.0);
  // Where parameters vary, the springs' energy also changes with the proxy's place; the chain rule
  // carries that gradient over to the hand.
  Vec3 rise = springs.rise;  // [N]
  bool varies = springs.varies;
  if (state_.relaxation.branch.stretch() != 0.0) {
    const Maxwell& branch =
        scene_.materials()[static_cast<std::size_t>(state_.relaxation.material)].maxwell;
    const MaterialMap::Sample own = branch.stiffness.sample(x);
    const double stretch = state_.relaxation.branch.stretch();
    relaxing = own.value * stretch * n;
    rise += 0.5 * stretch * stretch * own.gradient;
    varies = varies || !branch.stiffness.isConstant();
  }
  bool is_held_back = false;
  if (state_.friction.is_felt) {
    rise += springs.turn;
    state_.friction.lean = springs.stiffness > 0.0 ? rise / springs.stiffness : Vec3(0.0);
  } else if (varies || springs.turn != Vec3(0.0)) {
    const HeldWalls held = c.held();
    if (varies) elastic -= gradientByHand(rise, held.walls());
    if (springs.turn != Vec3(0.0)) {
      const Vec3 all = gradientByHand(springs.turn, held.walls());
      const double most = kMostTurn * glm::length(springs.force);
      const double length = glm::length(all);
      is_held_back = length > most;
      elastic -= is_held_back ? (most / length) * all : all;
    }
  }
  countLeap(c, hip, {springs.energy, elastic, is_held_back}, counted);
  Vec3 force = elastic + relaxing - damping * hip.velocity;
  // A wall never pulls the hand towards itself.
  const double along = glm::dot(force, n);
  if (along < 0.0) force -= along * n;
  return force;
}

}  // namespace palpate
