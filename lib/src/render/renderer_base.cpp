#include "renderer_base.h"

#include <algorithm>
#include <string>
#include <utility>

#include "constraint_renderer.h"
#include "palpate/contact/lattice_force.h"
#include "palpate/core/error.h"
#include "palpate/interior/partition.h"
#include "palpate/interior/port_machine.h"
#include "paper_renderer.h"
#include "state_check.h"

namespace palpate {
TickResult RendererBase::update(const HipState& hip) noexcept {
  SourceState& source = state_.source;
  if (!isInReach(hip.position) || !isFinite(hip.velocity)) {
    source.flow_push = Vec3(0.0);
    state_.last.event_count = 0;
    crossing_count_ = 0;
    entry_count_ = 0;
    unlimited_ = Vec3(0.0);
    TickResult held = state_.last;
    held.force = state_.guard.apply(Vec3(0.0), hip.dt);
    return held;
  }
  if (state_.has_begun) source.work += glm::dot(source.flow_push, hip.position - state_.hip);
  source.flow_push = Vec3(0.0);
  const bool was_in_lattice = std::exchange(source.in_lattice, false);
  TickResult out = step(hip);
  if (was_in_lattice && !source.in_lattice) {
    source.work -= std::exchange(source.lattice_energy, 0.0);
    source.lattice_region = kOutside;
  }
  unlimited_ = out.force;
  out.force = state_.guard.apply(out.force, hip.dt);
  state_.has_begun = true;
  state_.hip = hip.position;
  state_.last = out;
  crossing_count_ = out.event_count;
  entry_count_ = entered().size();
  return out;
}

ForceSlope HapticRenderer::slope(const HipState& /*hip*/) const noexcept { return {}; }

ForceSlope RendererBase::slope(const HipState& hip) const noexcept {
  const TickResult& answer = state_.last;
  ForceSlope out;
  out.drag = contents_.viscosity(answer.region, hip.position);
  if (!answer.contact) return out;
  const Vec3 spring = answer.proxy - hip.position;
  const double depth = glm::length(spring);
  if (!(depth > 0.0)) return out;
  out.normal = spring / depth;
  double bend = 1.0;
  if (state_.pressed >= 0) {
    const Material& material = scene_->materials()[static_cast<std::size_t>(state_.pressed)];
    out.damping = material.damping.at(answer.proxy);
    const bool stiffens = material.curve.stiffening.range().most > 0.0;
    bend = std::max(material.curve.exponent, stiffens ? 2.0 : 1.0);
  }
  const double elastic = glm::dot(out.normal, answer.force + out.damping * hip.velocity);
  out.stiffness = bend * std::max(0.0, elastic) / depth;
  if (state_.friction.sticks) out.sideways = out.stiffness;
  return out;
}

void RendererBase::reset() noexcept {
  ForceGuard guard = state_.guard;
  guard.reset();
  state_ = {};
  state_.kind = kind_;
  state_.guard = guard;
  state_.last.region = scene_->startRegion();
  crossing_count_ = 0;
  entry_count_ = 0;
  unlimited_ = Vec3(0.0);
  resume();
}

bool RendererBase::setState(const RendererState& sealed) noexcept {
  const TickState state = TickState::of(sealed);
  if (!isStateOf(state, kind_, *scene_)) return false;
  state_ = state;
  state_.kind = kind_;
  crossing_count_ = 0;
  entry_count_ = 0;
  unlimited_ = Vec3(0.0);
  resume();
  return true;
}

Vec3 RendererBase::dragForce(RegionId region, const Vec3& p, const Vec3& velocity,
                             double share) noexcept {
  const double viscosity = contents_.viscosity(region, p);
  if (!(viscosity > 0.0)) return Vec3(0.0);
  const Vec3 flow = contents_.flow(region, p);
  state_.source.flow_push = share * viscosity * flow;
  return -(share * viscosity * (velocity - flow));
}

Vec3 RendererBase::latticeForce(RegionId region, const Vec3& p) noexcept {
  if (!contents_.hasLattice(region)) return Vec3(0.0);
  const LatticePush push =
      latticePush(contents_.material(region)->lattice, contents_.latticeForce(region, p), p);
  // Changes of the potential by the hand's motion are work of the force. Any other change has no
  // such origin and counts as a source.
  SourceState& source = state_.source;
  const bool goes_on =
      source.lattice_region == region && source.lattice_version == contents_.version();
  if (!goes_on) source.work += push.energy - source.lattice_energy;
  source.lattice_energy = push.energy;
  source.lattice_region = region;
  source.lattice_version = contents_.version();
  source.in_lattice = true;
  return push.force;
}

std::unique_ptr<HapticRenderer> makeRenderer(ScenePtr scene, RendererSettings settings) {
  if (!scene) throw inputError("render.no_scene", "makeRenderer() was given no scene");
  const RendererKind kind = settings.kind.value_or(scene->renderer());
  if (kind != RendererKind::kConstraint && kind != RendererKind::kPaper) {
    throw inputError("render.kind",
                     "unknown kind of renderer: " + std::to_string(static_cast<int>(kind)));
  }
  if (kind == RendererKind::kPaper) {
    return std::make_unique<PaperRenderer>(std::move(scene), settings);
  }
  return std::make_unique<ConstraintRenderer>(std::move(scene), settings);
}

}  // namespace palpate
