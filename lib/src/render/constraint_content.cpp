#include <algorithm>
#include <cmath>

#include "constraint_renderer.h"

// What the hand feels of what is inside a region.

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

Vec3 ConstraintRenderer::contentForce(const HipState& hip) noexcept {
  const RegionId region = walker_.region();
  const Vec3& x = walker_.position();
  Vec3 force = dragForce(region, x, hip.velocity, content_share_);
  if (contents_.hasLattice(region)) {
    const Vec3 push = latticeForce(region, x);
    // On a wall the tip goes along with the hand's motion beside it only.
    force +=
        solver_.contact().count > 0 ? gradientByHand(push, solver_.contact().held().walls()) : push;
  }
  if (contents_.holdNeedles()) {
    force +=
        insertion_.step(contents_, scene_->ports(), {x, hip.velocity, region, walker_.crossings()});
  }
  return force;
}

}  // namespace palpate
