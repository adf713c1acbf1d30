#include "constraint_renderer.h"

#include "start_point.h"

namespace palpate {

ConstraintRenderer::ConstraintRenderer(ScenePtr scene, const RendererSettings& settings)
    : HapticRenderer(*scene, settings.limits),
      scene_(std::move(scene)),
      walker_(*scene_),
      beneath_(*scene_),
      solver_(*scene_, walker_) {}

void ConstraintRenderer::forget() noexcept {
  started_ = false;
  is_first_ = true;
  friction_ = {};
  pressed_ = -1;
  walker_.forget();
  branch_ = {};
  insertion_.reset();
}

TickResult ConstraintRenderer::step(const HipState& hip) noexcept {
  TickResult out;
  if (!started_) start(hip.position);
  walker_.beginTick();
  out.settled = solver_.track(hip.position, friction_, *this);
  fadeContent(hip.position);
  relax(hip.dt);

  out.proxy = walker_.position() + solver_.contact().snug;
  out.region = walker_.region();
  out.event_count = walker_.eventCount();
  out.events = walker_.events();
  out.force = wallForce(hip);
  out.contact = pressed_ >= 0;
  out.force += contentForce(hip);
  return out;
}

void ConstraintRenderer::start(const Vec3& hip) noexcept {
  walker_.place(startPoint(*scene_, walker_, hip));
  started_ = true;
  if (walker_.position() == hip) return;
  // From there the nearest point is found as any other: with all that leads out of the region shut.
  walker_.seal(true);
  walker_.beginTick();
  (void)solver_.track(hip, friction_, *this);
  walker_.seal(false);
  friction_.sticks = false;
}

bool ConstraintRenderer::open(const ContactSet& contact) noexcept {
  for (const WallContact& each : contact.walls()) {
    if (!each.facet.opens) continue;
    const double elastic = springOf(each).force(each.held.multiplier);
    if (elastic >= each.facet.opens_at &&
        each.held.multiplier >= walker_.punctures().restOf(each.facet.port)) {
      walker_.cross(each.leaf, each.facet, elastic);
      return true;
    }
  }
  return false;
}

}  // namespace palpate
