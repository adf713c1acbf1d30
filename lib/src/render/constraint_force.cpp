#include <algorithm>
#include <cmath>

#include "feel.h"
#include "palpate/contact/surface_effects.h"

// What the hand feels of the walls that hold the proxy.

namespace palpate {

/// The wall's normal smoothed, over the whole solid that the wall bounds: its facets may be leaves.
Vec3 Feel::shaded(const HeldWall& held, const Facet& facet, double radius) const noexcept {
  const RegionId here = walker_.region();
  const Field* solid = held.field;
  double side = held.side;
  if (here != facet.beyond) {
    const RegionId inner = std::max(here, facet.beyond);
    solid = scene_.regions()[inner].field.get();
    side = here == inner ? -1.0 : 1.0;
  }
  return shadedNormal(*solid, side, walker_.position(), held.normal, radius);
}

/// The Maxwell branch of the wall that is pressed most: stretched by how deep the hand presses now.
void Feel::relax(const ContactSet& c, double dt) noexcept {
  RelaxationState& branch = state_.relaxation;
  if (c.count == 0) {
    branch = {};
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
  const bool goes_on = branch.material == facet.material && branch.region == walker_.region();
  // Pressed from free space it is stretched by all of the depth. A wall that the proxy was handed on to was not
  // pressed by the hand's motion of this tick: it is taken as relaxed.
  const double before = goes_on || branch.material < 0 ? branch.depth : depth;
  if (!goes_on) branch.branch.reset();
  branch.material = facet.material;
  branch.region = walker_.region();
  branch.depth = depth;
  if (!has_branch) return;
  branch.branch.step(depth - before, dt, wall.maxwell.time);
  const double stiffness = wall.maxwell.stiffness.at(walker_.position());
  // It slackens rather than to pull the wall's own spring below zero.
  if (stiffness > 0.0) branch.branch.keepAbove(-springOf(c.wall[most]).force(depth) / stiffness);
}

/// [N/m] What the held wall is pressed against, by the place of the proxy: its material's, or that of the
/// layers behind it.
MaterialMap::Sample Feel::stiffnessOf(const WallContact& contact) noexcept {
  const Material& wall = wallMaterial(contact.facet);
  if (wall.composite.radius > 0.0 && contact.facet.beyond != walker_.region()) {
    return beneath_.stiffness(contact.leaf, walker_.position(), contact.held, contact.facet, wall);
  }
  return wall.stiffness.sample(walker_.position());
}

/// What the walls push with: the springs between the proxy and the hand. Whatever the walls were found to
/// be, for one stiffness it is that times the way from the hand to the proxy.
Vec3 Feel::walls(const ContactSet& c, const HipState& hip) noexcept {
  relax(c, hip.dt);
  const Vec3& x = walker_.position();
  const Vec3 apart = x - hip.position;
  state_.friction.lean = Vec3(0.0);
  if (apart == Vec3(0.0)) {
    state_.pressed = -1;
    return Vec3(0.0);
  }
  if (c.count == 0) {
    // On its way, out of budget: it is drawn on by the wall that it was held by.
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
  const double lag = glm::dot(c.lag, c.lag) / total;
  Vec3 force(0.0);
  double stiffness = 0.0;
  double damping = 0.0;
  // What parameters that vary add: the energy of the springs as they are, by the place of the proxy, is handed
  // on to the hand.
  Vec3 rise(0.0);  // [N]
  bool varies = false;
  for (const WallContact& each : c.walls()) {
    const Material& wall = wallMaterial(each.facet);
    const HeldWall& held = each.held;
    const double multiplier = held.multiplier;
    const MaterialMap::Sample linear = stiffnessOf(each);
    const MaterialMap::Sample stiffening = wall.curve.stiffening.sample(x);
    const WallSpring spring{linear.value, stiffening.value, wall.curve.exponent,
                            wall.curve.reference};
    const bool is_even = linear.gradient == Vec3(0.0) && stiffening.gradient == Vec3(0.0);
    double length = multiplier;
    if (!is_even || !spring.isStraight()) {
      // From the proxy to the hand, with what friction holds.
      length = std::sqrt(std::max(0.0, multiplier * (glm::dot(held.normal, outward) + lag)));
    }
    const double secant = spring.secant(length);
    const Vec3 normal = wall.shading > 0.0 ? shaded(held, each.facet, wall.shading) : held.normal;
    force += secant * (multiplier + textureHeight(wall.texture, x, multiplier)) * normal;
    stiffness += secant * multiplier;
    damping += wall.damping.at(x) * multiplier;
    if (is_even) continue;
    varies = true;
    rise += spring.energyPerStiffness(length) * linear.gradient +
            WallSpring::energyPerStiffening(length) * stiffening.gradient;
  }
  stiffness /= total;
  damping /= total;
  // What the walls do not hold of the displacement: by friction, or because the proxy is not there yet.
  force -= stiffness * c.left + damping * hip.velocity;
  if (state_.relaxation.branch.stretch() != 0.0) {
    const Maxwell& branch =
        scene_.materials()[static_cast<std::size_t>(state_.relaxation.material)].maxwell;
    const MaterialMap::Sample own = branch.stiffness.sample(x);
    const double stretch = state_.relaxation.branch.stretch();
    force += own.value * stretch * n;
    rise += 0.5 * stretch * stretch * own.gradient;
    varies = varies || !branch.stiffness.isConstant();
  }
  if (state_.friction.is_felt) {
    state_.friction.lean = rise / stiffness;
  } else if (varies) {
    force -= gradientByHand(rise, c.held().walls());
  }
  // A wall never pulls the hand towards itself.
  const double along = glm::dot(force, n);
  if (along < 0.0) force -= along * n;
  return force;
}

}  // namespace palpate
