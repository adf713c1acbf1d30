#include "palpate/render/haptic_renderer.h"

#include "constraint_renderer.h"
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
    last_ = step(hip);
    last_.force = guard_.apply(last_.force, hip.dt);
    return last_;
  }
  last_.event_count = 0;
  TickResult held = last_;
  held.force = guard_.apply(Vec3(0.0), hip.dt);
  return held;
}

void HapticRenderer::reset() noexcept {
  guard_.reset();
  last_ = {};
  last_.region = start_;
  forget();
}

std::unique_ptr<HapticRenderer> makeRenderer(ScenePtr scene, RendererSettings settings) {
  if (!scene) throw inputError("render.no_scene", "makeRenderer() was given no scene");
  if (settings.kind.value_or(scene->renderer()) == RendererKind::kPaper) {
    return std::make_unique<PaperRenderer>(std::move(scene), settings);
  }
  return std::make_unique<ConstraintRenderer>(std::move(scene), settings);
}

}  // namespace palpate
