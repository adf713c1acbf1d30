#include <algorithm>
#include <cmath>

#include "constraint_renderer.h"
#include "palpate/contact/surface_effects.h"

// What the hand feels of the walls that hold the proxy.

namespace palpate {

/// The wall's normal smoothed, over the whole solid that the wall bounds: its facets may be leaves.
Vec3 ConstraintRenderer::shaded(const HeldWall& held, const Facet& facet,
                                double radius) const noexcept {
  const RegionId here = walker_.region();
  const Field* solid = held.field;
  double side = held.side;
  if (here != facet.beyond) {
    const RegionId inner = std::max(here, facet.beyond);
    solid = scene_->regions()[inner].field.get();
    side = here == inner ? -1.0 : 1.0;
  }
  return shadedNormal(*solid, side, walker_.position(), held.normal, radius);
}

/// The Maxwell branch of the wall that is pressed most: stretched by how deep the hand presses now.
void ConstraintRenderer::relax(double dt) noexcept {
  const Contact& c = contact_;
  if (c.count == 0) {
    branch_ = {};
    return;
  }
  std::size_t most = 0;
  for (std::size_t i = 1; i < c.count; ++i) {
    if (c.held[i].multiplier > c.held[most].multiplier) most = i;
  }
  const Facet& facet = c.facet[c.index[most]];
  const Material& wall = wallMaterial(facet);
  const bool has_branch = wall.maxwell.time > 0.0;
  const double depth = has_branch ? c.load() : 0.0;
  const bool goes_on = branch_.material == facet.material && branch_.region == walker_.region();
  // Pressed from free space it is stretched by all of the depth. A wall that the proxy was handed on to was not
  // pressed by the hand's motion of this tick: it is taken as relaxed.
  const double before = goes_on || branch_.material < 0 ? branch_.depth : depth;
  if (!goes_on) branch_.state.reset();
  branch_.material = facet.material;
  branch_.region = walker_.region();
  branch_.depth = depth;
  if (!has_branch) return;
  branch_.state.step(depth - before, dt, wall.maxwell.time);
  const double stiffness = wall.maxwell.stiffness.at(walker_.position());
  // It slackens rather than to pull the wall's own spring below zero.
  if (stiffness > 0.0) branch_.state.keepAbove(-springOf(most).force(depth) / stiffness);
}

/// [N/m] What the held wall is pressed against, by the place of the proxy: its material's, or that of the
/// layers behind it.
MaterialMap::Sample ConstraintRenderer::stiffnessOf(std::size_t held) noexcept {
  const std::size_t plane = contact_.index[held];
  const Facet& facet = contact_.facet[plane];
  const Material& wall = wallMaterial(facet);
  if (wall.composite.radius > 0.0 && facet.beyond != walker_.region()) {
    return beneath_.stiffness(contact_.leaf[plane], walker_.position(), contact_.held[held], facet,
                              wall);
  }
  return wall.stiffness.sample(walker_.position());
}

Vec3 ConstraintRenderer::wallForce(const Vec3& velocity) noexcept {
  const Contact& c = contact_;
  Vec3 force(0.0);
  lean_ = Vec3(0.0);
  if (c.count == 0) return force;
  const Vec3& x = walker_.position();
  double total = 0.0;
  Vec3 outward(0.0);
  for (const HeldWall& held : c.walls()) {
    outward += held.multiplier * held.normal;
    total += held.multiplier;
  }
  const Vec3 n = unitOr(outward, Vec3(0.0));
  const double lag = glm::dot(c.lag, c.lag) / total;
  double stiffness = 0.0;
  double damping = 0.0;
  // What parameters that vary add: the energy of the springs as they are, by the place of the proxy, is handed
  // on to the hand.
  Vec3 rise(0.0);  // [N]
  bool varies = false;
  for (std::size_t i = 0; i < c.count; ++i) {
    const Material& wall = wallMaterial(c.facet[c.index[i]]);
    const HeldWall& held = c.held[i];
    const double multiplier = held.multiplier;
    const MaterialMap::Sample linear = stiffnessOf(i);
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
    const Vec3 normal =
        wall.shading > 0.0 ? shaded(held, c.facet[c.index[i]], wall.shading) : held.normal;
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
  force -= stiffness * c.lag + damping * velocity;
  if (branch_.state.stretch() != 0.0) {
    const Maxwell& branch = scene_->materials()[static_cast<std::size_t>(branch_.material)].maxwell;
    const MaterialMap::Sample own = branch.stiffness.sample(x);
    const double stretch = branch_.state.stretch();
    force += own.value * stretch * n;
    rise += 0.5 * stretch * stretch * own.gradient;
    varies = varies || !branch.stiffness.isConstant();
  }
  if (has_friction_) {
    lean_ = rise / stiffness;
  } else if (varies) {
    force -= gradientByHand(rise, c.walls());
  }
  // A wall never pulls the hand towards itself.
  const double along = glm::dot(force, n);
  if (along < 0.0) force -= along * n;
  return force;
}

}  // namespace palpate
