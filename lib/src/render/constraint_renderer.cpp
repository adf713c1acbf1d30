#include "constraint_renderer.h"

#include <algorithm>

#include "start_point.h"

namespace palpate {

ConstraintRenderer::ConstraintRenderer(ScenePtr scene, const RendererSettings& settings)
    : RendererBase(std::move(scene), RendererKind::kConstraint, settings.limits),
      walker_(*scene_, state_.place),
      solver_(*scene_, walker_),
      feel_(*scene_, walker_, state_) {}

void ConstraintRenderer::resume() noexcept {
  if (state_.has_begun) walker_.resume();
}

TickResult ConstraintRenderer::step(const HipState& hip) noexcept {
  TickResult out;
  if (!state_.has_begun) start(hip.position);
  walker_.beginTick();
  hand_ = hip.position;
  velocity_ = hip.velocity;
  has_given_way_ = false;
  out.settled = solver_.track(hip.position, state_.friction, *this);
  const double in_walls = has_given_way_ ? feel_.stored(solver_.contact(), hip.position) : 0.0;
  const double in_tissue = state_.needle.stored();
  if (has_given_way_) state_.source.stored.leaves.clear();  // counted below
  feel_.fadeContent(hip.position);

  out.proxy = walker_.position() + solver_.contact().snug;
  out.region = walker_.region();
  out.event_count = walker_.eventCount();
  out.events = walker_.events();
  out.force = feel_.walls(solver_.contact(), hip);
  out.contact = state_.pressed >= 0;
  out.force += contentForce(hip);
  if (has_given_way_) {
    // When a wall ruptures it throws the tip on, against stiffer walls and into tissue that sticks
    // to the shaft. The energy gained is counted as a source.
    state_.source.work += std::max(0.0, in_walls + state_.needle.stored() - in_tissue - released_);
  }
  return out;
}

void ConstraintRenderer::start(const Vec3& hip) noexcept {
  walker_.place(startPoint(*scene_, walker_, hip));
  if (walker_.position() == hip) return;
  // From there the nearest point is found as in any tick, but with everything that leads out of the
  // region shut.
  walker_.seal(true);
  walker_.beginTick();
  (void)solver_.track(hip, state_.friction, *this);
  walker_.seal(false);
  state_.friction.sticks = false;
}

bool ConstraintRenderer::open(const ContactSet& contact) noexcept {
  // NOLINTNEXTLINE(readability-use-anyofallof): it does more than look.
  for (const WallContact& each : contact.walls()) {
    if (!each.facet.opens) continue;
    const double elastic = feel_.springOf(each).force(each.held.multiplier);
    // Nothing is torn in a hole, so the speed does not matter.
    const double share =
        each.facet.in_hole
            ? 1.0
            : scene_->ports()[each.facet.port].rate.share(-glm::dot(velocity_, each.held.normal));
    if (elastic >= share * each.facet.opens_at &&
        each.held.multiplier >= walker_.punctures().restOf(each.facet.port)) {
      if (!has_given_way_) released_ = feel_.stored(contact, hand_);
      has_given_way_ = true;
      walker_.cross(each.leaf, each.facet, elastic);
      return true;
    }
  }
  return false;
}

Vec3 ConstraintRenderer::needleForce(const HipState& hip) noexcept {
  const HeldWalls held = solver_.contact().held();
  HeldWalls hard;
  for (const WallContact& each : solver_.contact().walls()) {
    if (!each.facet.opens) hard.wall[hard.count++] = each.held;
  }
  const Insertion::Force force =
      state_.needle.step(contents_, {walker_.position(), hip.position, hip.velocity,
                                     walker_.region(), walker_.entries(), hard.walls()});
  // The sideways energy depends on the place of the tip, which on a wall follows the hand only
  // along the wall.
  return force.tip + (held.count > 0 ? gradientByHand(force.lateral, held.walls()) : force.lateral);
}

Vec3 ConstraintRenderer::contentForce(const HipState& hip) noexcept {
  const RegionId region = walker_.region();
  const Vec3& x = walker_.position();
  Vec3 force = dragForce(region, x, hip.velocity, state_.fade.share);
  if (contents_.hasLattice(region)) {
    const Vec3 push = latticeForce(region, x);
    // On a wall the tip follows the hand's motion only along the wall.
    force +=
        solver_.contact().count > 0 ? gradientByHand(push, solver_.contact().held().walls()) : push;
  }
  if (contents_.holdNeedles()) force += needleForce(hip);
  return force;
}

}  // namespace palpate
