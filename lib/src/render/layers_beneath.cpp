#include "layers_beneath.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Of the depth: where the ray begins behind the wall. A layer thinner than that is not felt.
constexpr double kBehind = 1e-6;
/// Of the depth, at its end: where what differs from the layer before fades out.
constexpr double kFade = 0.25;
/// Facets that one ray crosses, sheets and openings included.
constexpr int kMostCrossings = 12;
/// Cosine of the ray and an interface's normal below which the interface's depth has no slope: the ray grazes it.
constexpr double kGrazing = 0.05;
/// [-] of a stiffness, to take differences over.
constexpr double kStep = 1e-4;

/// The part of `v` along a wall.
Vec3 alongWall(const Vec3& v, const Vec3& normal) noexcept {
  return v - glm::dot(v, normal) * normal;
}

/// A gradient at depth `s` along the ray, as one by the place on the wall where the ray begins: it turns with
/// the wall's normal.
Vec3 fromWall(const Vec3& gradient, double s, const HeldWall& held) noexcept {
  const Vec3 bend = held.side / glm::length(held.jet.gradient) *
                    (held.jet.hessian * alongWall(gradient, held.normal));
  return alongWall(gradient - s * bend, held.normal);
}

}  // namespace

MaterialMap::Sample LayersBeneath::stiffness(LeafId leaf, const Vec3& x, const HeldWall& held,
                                             const Facet& facet,
                                             const Material& material) noexcept {
  if (has_last_ && last_leaf_ == leaf && last_x_ == x && last_beyond_ == facet.beyond) return last_;
  has_last_ = true;
  last_leaf_ = leaf;
  last_x_ = x;
  last_beyond_ = facet.beyond;
  const MaterialMap::Sample own = material.stiffness.sample(x);
  found_.count = 1;
  found_.layers[0] = {own.value, 0.0};
  found_.rise[0] = alongWall(own.gradient, held.normal);
  found_.slope[0] = Vec3(0.0);
  found_.top[0] = 0.0;
  look(x, held, material);

  const std::span<StackLayer> layers(found_.layers.data(), found_.count);
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    layers[i].thickness = found_.top[i + 1] - found_.top[i];
  }
  const double radius = material.composite.radius;
  const StackStiffness all = stackStiffness(layers, radius, true);
  last_ = {all.stiffness, Vec3(0.0)};
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    last_.gradient += all.by_thickness[i] * (found_.slope[i + 1] - found_.slope[i]);
  }
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (found_.rise[i] == Vec3(0.0)) continue;
    const double stiff = layers[i].stiffness;
    layers[i].stiffness = stiff * (1.0 + kStep);
    const double more = stackStiffness(layers, radius, false).stiffness;
    layers[i].stiffness = stiff;
    last_.gradient += (more - all.stiffness) / (kStep * stiff) * found_.rise[i];
  }
  return last_;
}

void LayersBeneath::look(const Vec3& x, const HeldWall& held, const Material& material) noexcept {
  const double depth = material.composite.depth;
  const Vec3 end = x - depth * held.normal;
  probe_.forget();
  probe_.place(x - kBehind * depth * held.normal);
  probe_.beginTick();
  for (int i = 0; i < kMostCrossings && found_.count < kMostStackLayers; ++i) {
    const RegionId before = probe_.region();
    const CellWalker::Stop stop = probe_.move(end, {}, true);
    if (stop == CellWalker::Stop::kArrived || stop == CellWalker::Stop::kSpent) return;
    LeafId leaf = probe_.blockedBy();
    if (stop == CellWalker::Stop::kCrossed) {
      if (probe_.mouth() < 0) return;
      leaf = static_cast<LeafId>(probe_.mouth());
    } else {
      probe_.cross(leaf, probe_.facetAt(leaf));
    }
    if (probe_.region() == kOutside) return;
    if (probe_.region() != before) add(probe_.region(), leaf, x, held, depth);
  }
}

/// The layer that the probe has just come to, through a facet of `leaf`.
void LayersBeneath::add(RegionId region, LeafId leaf, const Vec3& x, const HeldWall& held,
                        double depth) noexcept {
  const int wall = scene_.regions()[region].wall;
  if (wall < 0) return;
  const Vec3 at = probe_.position();
  const double s = glm::dot(x - at, held.normal);
  const Vec3 gradient = probe_.leaf(leaf).field->sample(at).gradient;
  const double slant = glm::dot(gradient, held.normal);
  Vec3 slope(0.0);
  if (std::fabs(slant) > kGrazing * glm::length(gradient)) {
    slope = fromWall(gradient, s, held) / slant;
  }
  const MaterialMap::Sample own =
      scene_.materials()[static_cast<std::size_t>(wall)].stiffness.sample(at);
  const double left = std::clamp((depth - s) / (kFade * depth), 0.0, 1.0);
  const double share = left * left * (3.0 - 2.0 * left);
  const double share_by_depth = -6.0 * left * (1.0 - left) / (kFade * depth);
  const std::size_t i = found_.count++;
  const double before = found_.layers[i - 1].stiffness;
  const Vec3 own_rise = own.gradient == Vec3(0.0) ? Vec3(0.0)
                                                  : fromWall(own.gradient, s, held) -
                                                        glm::dot(own.gradient, held.normal) * slope;
  found_.layers[i] = {before + share * (own.value - before), 0.0};
  found_.rise[i] = (1.0 - share) * found_.rise[i - 1] + share * own_rise +
                   share_by_depth * (own.value - before) * slope;
  found_.slope[i] = slope;
  found_.top[i] = s;
}

}  // namespace palpate
