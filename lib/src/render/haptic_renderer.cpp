#include "palpate/render/haptic_renderer.h"

#include <utility>

#include "constraint_renderer.h"
#include "palpate/contact/lattice_force.h"
#include "palpate/core/error.h"
#include "paper_renderer.h"

namespace palpate {
namespace {

/// False for NaN too.
bool isNear(const Vec3& p) noexcept {
  constexpr double kFarthest = HapticRenderer::kFarthest;
  return std::fabs(p.x) <= kFarthest && std::fabs(p.y) <= kFarthest && std::fabs(p.z) <= kFarthest;
}

}  // namespace

TickResult HapticRenderer::update(const HipState& hip) noexcept {
  if (isNear(hip.position) && isFinite(hip.velocity)) {
    if (has_hip_) source_work_ += glm::dot(flow_push_, hip.position - last_hip_);
    has_hip_ = true;
    last_hip_ = hip.position;
    flow_push_ = Vec3(0.0);
    const bool was_in_lattice = std::exchange(in_lattice_, false);
    last_ = step(hip);
    if (was_in_lattice && !in_lattice_) {
      source_work_ -= std::exchange(lattice_energy_, 0.0);
      lattice_region_ = kOutside;
    }
    last_.force = guard_.apply(last_.force, hip.dt);
    return last_;
  }
  flow_push_ = Vec3(0.0);
  last_.event_count = 0;
  TickResult held = last_;
  held.force = guard_.apply(Vec3(0.0), hip.dt);
  return held;
}

void HapticRenderer::reset() noexcept {
  guard_.reset();
  last_ = {};
  last_.region = start_;
  has_hip_ = false;
  lattice_energy_ = 0.0;
  in_lattice_ = false;
  lattice_region_ = kOutside;
  source_work_ = 0.0;
  forget();
}

Vec3 HapticRenderer::dragForce(RegionId region, const Vec3& p, const Vec3& velocity,
                               double share) noexcept {
  const double viscosity = contents_.viscosity(region, p);
  if (!(viscosity > 0.0)) return Vec3(0.0);
  const Vec3 flow = contents_.flow(region);
  flow_push_ = share * viscosity * flow;
  return -(share * viscosity * (velocity - flow));
}

Vec3 HapticRenderer::latticeForce(RegionId region, const Vec3& p) noexcept {
  if (!contents_.hasLattice(region)) return Vec3(0.0);
  const LatticePush push =
      latticePush(contents_.material(region)->lattice, contents_.latticeForce(region, p), p);
  // What the hand's motion changes the potential by, the force gives or takes. All else comes from nowhere.
  const bool goes_on = lattice_region_ == region && lattice_version_ == contents_.version();
  if (!goes_on) source_work_ += push.energy - lattice_energy_;
  lattice_energy_ = push.energy;
  lattice_region_ = region;
  lattice_version_ = contents_.version();
  in_lattice_ = true;
  return push.force;
}

std::unique_ptr<HapticRenderer> makeRenderer(ScenePtr scene, RendererSettings settings) {
  if (!scene) throw inputError("render.no_scene", "makeRenderer() was given no scene");
  if (settings.kind.value_or(scene->renderer()) == RendererKind::kPaper) {
    return std::make_unique<PaperRenderer>(std::move(scene), settings);
  }
  return std::make_unique<ConstraintRenderer>(std::move(scene), settings);
}

}  // namespace palpate
