#include <algorithm>
#include <cmath>

#include "constraint_renderer.h"
#include "palpate/contact/surface_effects.h"

// What the hand feels: walls and content.

namespace palpate {
namespace {

/// Content is felt in full this far behind the facet it was entered through [m], so that hovering in a
/// mouth does not chatter.
constexpr double kFadeLength = 0.25e-3;

}  // namespace

double ConstraintRenderer::contentShare() noexcept {
  if (walker_.mouth() < 0) return 1.0;
  const auto mouth = static_cast<LeafId>(walker_.mouth());
  const FieldSample s = walker_.leaf(mouth).field->sample(walker_.position());
  const double slope = s.in_band ? glm::length(s.gradient) : 1.0;
  const double behind = slope > 0.0 ? std::fabs(s.value) / slope : kFadeLength;
  if (behind >= kFadeLength) return 1.0;
  // Only an opening is hovered in: behind a valve that has shut, and along the wall beside the mouth, the
  // content is there in full.
  const Facet::Kind kind = walker_.facetAt(mouth).kind;
  const bool is_open = kind == Facet::Kind::kOpen || kind == Facet::Kind::kAbsent;
  return is_open ? behind / kFadeLength : 1.0;
}

/// The share of the content that is felt changes no faster than the hand moves, wherever an opening ends.
void ConstraintRenderer::fadeContent(const Vec3& hip) noexcept {
  const double share = contentShare();
  if (is_first_) {
    content_share_ = share;
  } else {
    const double most = glm::length(hip - last_hip_) / kFadeLength;
    if (walker_.region() != felt_region_) content_share_ = 0.0;
    content_share_ = std::clamp(share, content_share_ - most, content_share_ + most);
  }
  felt_region_ = walker_.region();
  last_hip_ = hip;
  is_first_ = false;
}

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

/// What a stiffness that varies adds (materials/material.h): the energy of the springs as they are, by the
/// place of the proxy, is handed on to the hand. `slopes` [N/m^2] are the gradients of the walls' stiffness.
Vec3 ConstraintRenderer::stiffnessForce(const std::array<Vec3, 3>& slopes, const Vec3& load,
                                        double total) const noexcept {
  const Contact& c = contact_;
  // Held by friction, the proxy stays where it is, whatever the hand does.
  if (sticking_) return Vec3(0.0);
  Vec3 rise(0.0);  // [N]
  for (std::size_t i = 0; i < c.count; ++i) {
    const HeldWall& held = c.held[i];
    const double lag = glm::dot(c.lag, c.lag) / total;
    rise += 0.5 * held.multiplier * (glm::dot(held.normal, load) + lag) * slopes[i];
  }
  return -gradientByHand(rise, c.walls());
}

Vec3 ConstraintRenderer::force(const HipState& hip) const noexcept {
  const Contact& c = contact_;
  Vec3 force(0.0);
  if (c.count > 0) {
    double total = 0.0;
    double stiffness = 0.0;
    double damping = 0.0;
    Vec3 outward(0.0);
    std::array<Vec3, 3> slopes{};
    bool varies = false;
    for (std::size_t i = 0; i < c.count; ++i) {
      const Material& wall = wallMaterial(c.facet[c.index[i]]);
      const HeldWall& held = c.held[i];
      const double multiplier = held.multiplier;
      const Vec3& x = walker_.position();
      const MaterialMap::Sample own = wall.stiffness.sample(x);
      const Vec3 n =
          wall.shading > 0.0 ? shaded(held, c.facet[c.index[i]], wall.shading) : held.normal;
      force += own.value * (multiplier + textureHeight(wall.texture, x, multiplier)) * n;
      outward += multiplier * held.normal;
      total += multiplier;
      stiffness += own.value * multiplier;
      damping += wall.damping.at(x) * multiplier;
      slopes[i] = own.gradient;
      varies = varies || own.gradient != Vec3(0.0);
    }
    stiffness /= total;
    damping /= total;
    force -= stiffness * c.lag + damping * hip.velocity;
    if (varies) force += stiffnessForce(slopes, outward, total);
    // A wall never pulls the hand towards itself.
    const Vec3 n = unitOr(outward, Vec3(0.0));
    const double along = glm::dot(force, n);
    if (along < 0.0) force -= along * n;
  }
  const int content = scene_->regions()[walker_.region()].content;
  if (content >= 0) {
    const Material& medium = scene_->materials()[static_cast<std::size_t>(content)];
    const double viscosity = medium.viscosity.at(walker_.position());
    if (viscosity > 0.0) force -= content_share_ * viscosity * (hip.velocity - medium.flow);
  }
  return force;
}

}  // namespace palpate
