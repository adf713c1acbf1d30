#include "support/rivals/rival_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/interior/port_machine.h"

namespace palpate::rivals {

RivalRenderer::RivalRenderer(ScenePtr scene) : scene_(std::move(scene)) {
  for (std::size_t i = 1; i < scene_->regions().size(); ++i) {
    const FieldPtr& field = scene_->regions()[i].field;
    const Wall& wall = scene_->passages().wall(kOutside, static_cast<RegionId>(i));
    if (!field || wall.absent || wall.material < 0) continue;
    const Material& material = scene_->materials()[static_cast<std::size_t>(wall.material)];
    solids_.push_back({field, material.stiffness.at(Vec3(0.0)), material.damping.at(Vec3(0.0))});
  }
  if (solids_.empty()) {
    throw inputError("rivals.no_solid", "the scene has no solid that can be touched from outside");
  }
}

TickResult RivalRenderer::update(const HipState& hip) noexcept {
  const Vec3 size = glm::abs(hip.position);
  const bool is_good = isFinite(hip.position) && isFinite(hip.velocity) &&
                       std::max({size.x, size.y, size.z}) <= kFarthest;
  if (is_good) {
    last_ = step(hip);
  } else {
    last_.force = Vec3(0.0);
  }
  return last_;
}

void RivalRenderer::reset() noexcept {
  last_ = {};
  forget();
}

const Solid* RivalRenderer::deepestAt(const Vec3& p) const noexcept {
  const Solid* deepest = nullptr;
  double least = 0.0;
  for (const Solid& solid : solids_) {
    const double value = solid.field->value(p);
    if (!(value < least)) continue;
    least = value;
    deepest = &solid;
  }
  return deepest;
}

TickResult RivalRenderer::spring(const HipState& hip, const Vec3& proxy, const Solid& solid,
                                 RegionId region) noexcept {
  TickResult out;
  out.proxy = proxy;
  out.region = region;
  out.contact = true;
  const Vec3 apart = proxy - hip.position;
  const Vec3 n = unitOr(apart, Vec3(0.0));
  const double damper =
      std::min(solid.damping * glm::dot(hip.velocity, n), solid.stiffness * glm::length(apart));
  out.force = solid.stiffness * apart - damper * n;
  return out;
}

TickResult RivalRenderer::untouched(const HipState& hip) const noexcept {
  TickResult out;
  out.proxy = hip.position;
  out.region = region();
  return out;
}

Vec3 downTheGradient(const Field& field, Vec3 p) noexcept {
  constexpr int kSteps = 20;
  for (int i = 0; i < kSteps; ++i) {
    const FieldSample s = field.sample(p);
    const double square = glm::dot(s.gradient, s.gradient);
    if (!(square > 0.0)) break;
    p -= s.value / square * s.gradient;
    if (std::fabs(s.value) < 1e-12 * field.featureSize()) break;
  }
  return p;
}

}  // namespace palpate::rivals
