#include "layers_beneath.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Share of the depth: within this distance of the wall the ray counts as at the wall.
constexpr double kAtWall = 1e-6;
/// Share of the depth, at its end, over which the difference from the layer before fades out.
constexpr double kFade = 0.25;
/// Cosine of the angle between two normals above which two surfaces at one place count as one.
constexpr double kParallel = 1.0 - 1e-12;
/// The most facets that one ray crosses, sheets and openings included.
constexpr int kMostCrossings = 12;
/// Cosine of the angle between the ray and an interface's normal below which the slope of the
/// interface's depth is ignored, because the ray grazes it.
constexpr double kGrazing = 1e-3;

/// The part of `v` along a wall.
Vec3 alongWall(const Vec3& v, const Vec3& normal) noexcept {
  return v - glm::dot(v, normal) * normal;
}

/// Derivative of (the wall's normal times `v`) by the place on the wall.
Vec3 turnOf(const Vec3& v, const HeldWall& held) noexcept {
  const Vec3 along = alongWall(v, held.normal);
  return held.side / glm::length(held.jet.gradient) * (held.jet.hessian * along);
}

/// Converts a gradient at depth `s` along the ray into one by the place on the wall where the ray
/// begins: the ray turns with the wall's normal.
Vec3 fromWall(const Vec3& gradient, double s, const HeldWall& held) noexcept {
  return alongWall(gradient - s * turnOf(gradient, held), held.normal);
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
  look(x, held, facet.beyond, material.composite.depth);

  const std::span<StackLayer> layers(found_.layers.data(), found_.count);
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    layers[i].thickness = found_.top[i + 1] - found_.top[i];
  }
  const StackStiffness all = stackStiffness(layers, material.composite.radius);
  last_ = {all.stiffness, all.by_stiffness[0] * found_.rise[0]};
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    last_.gradient += all.by_thickness[i] * (found_.slope[i + 1] - found_.slope[i]) +
                      all.by_stiffness[i + 1] * found_.rise[i + 1];
  }
  return last_;
}

/// The ray begins at the proxy, so that layers that cover the wall are met as well.
void LayersBeneath::look(const Vec3& x, const HeldWall& held, RegionId beyond,
                         double depth) noexcept {
  const Vec3 end = x - depth * held.normal;
  place_.passed.clear();
  place_.punctures.clear();
  probe_.standWith(proxy_);
  probe_.beginTick();
  const RegionId front = probe_.region();
  bool is_behind = false;
  for (int i = 0; i < kMostCrossings && found_.count < kMostStackLayers; ++i) {
    const RegionId before = probe_.region();
    const CellWalker::Stop stop = probe_.move(end, true);
    if (stop == CellWalker::Stop::kArrived || stop == CellWalker::Stop::kSpent) return;
    LeafId leaf = probe_.blockedBy();
    if (stop == CellWalker::Stop::kCrossed) {
      if (probe_.mouth() < 0) return;
      leaf = static_cast<LeafId>(probe_.mouth());
    } else {
      probe_.cross(leaf, probe_.facetAt(leaf));
    }
    const RegionId region = probe_.region();
    if (region == before) continue;
    is_behind = is_behind || glm::dot(x - probe_.position(), held.normal) > kAtWall * depth;
    const RegionId from = is_behind ? before : beyond;
    if (!is_behind) {
      // Only the last of the layers before the wall counts, since it covers the wall.
      found_.count = 1;
      is_behind = region == beyond || isFlush(leaf, x, held, depth);
      if (is_behind || region == front) continue;
    }
    if (region == kOutside) return;
    add(from, leaf, x, held, depth);
  }
}

/// Whether the surface of the leaf that the probe has just crossed coincides with the wall here: a
/// layer that lies behind it beside the wall is not seen through the wall.
bool LayersBeneath::isFlush(LeafId leaf, const Vec3& x, const HeldWall& held,
                            double depth) noexcept {
  if (std::fabs(glm::dot(x - probe_.position(), held.normal)) > kAtWall * depth) return false;
  const Vec3 gradient = probe_.jetHere(leaf).gradient;
  return std::fabs(glm::dot(gradient, held.normal)) >= kParallel * glm::length(gradient);
}

/// Adds the layer that the probe has just entered from the region `from`, through a facet of
/// `leaf`. A layer that covers the wall begins where the wall is.
void LayersBeneath::add(RegionId from, LeafId leaf, const Vec3& x, const HeldWall& held,
                        double depth) noexcept {
  const RegionId region = probe_.region();
  const int wall = scene_.regions()[region].wall;
  if (wall < 0) return;
  const Vec3 at = probe_.position();
  const double s = glm::dot(x - at, held.normal);
  const FieldJet jet = probe_.leaf(leaf).field->jet(at);
  const double steepness = glm::length(jet.gradient);
  const double slant = glm::dot(jet.gradient, held.normal);
  Vec3 slope(0.0);
  if (std::fabs(slant) > kGrazing * steepness) slope = fromWall(jet.gradient, s, held) / slant;
  // The gradient, by the place on the wall, of a quantity at the interface, whose depth changes as
  // well.
  const auto by_place = [&](const Vec3& v) {
    return fromWall(v, s, held) - glm::dot(v, held.normal) * slope;
  };
  const MaterialMap::Sample own =
      scene_.materials()[static_cast<std::size_t>(wall)].stiffness.sample(at);
  const bool covers = s < 0.0;
  const double left = std::clamp((depth - s) / (kFade * depth), 0.0, 1.0);
  double share = left * left * (3.0 - 2.0 * left);
  Vec3 share_rise = -6.0 * left * (1.0 - left) / (kFade * depth) * slope;
  const double cosine = steepness > 0.0 ? std::fabs(slant) / steepness : 1.0;
  if (region > from && cosine < 1.0) {
    // The length of a chord near a layer's rim grows with infinite slope. So a layer counts less
    // the flatter the ray meets it: its share is the quintic smoothstep of the cosine.
    const Vec3 normal = jet.gradient / (slant < 0.0 ? -steepness : steepness);
    const Vec3 row =
        jet.hessian * (held.normal - cosine * normal) / (slant < 0.0 ? -steepness : steepness);
    const Vec3 cosine_rise = alongWall(turnOf(normal, held), held.normal) + by_place(row);
    const double square = cosine * cosine;
    const double weight = cosine * square * (10.0 - 15.0 * cosine + 6.0 * square);
    const double weight_rise = 30.0 * square * (1.0 - cosine) * (1.0 - cosine);
    share_rise = weight * share_rise + share * weight_rise * cosine_rise;
    share *= weight;
  }
  const std::size_t i = found_.count++;
  const double before = found_.layers[i - 1].stiffness;
  const Vec3 own_rise = own.gradient == Vec3(0.0) ? Vec3(0.0) : by_place(own.gradient);
  found_.layers[i] = {before + share * (own.value - before), 0.0};
  found_.rise[i] =
      (1.0 - share) * found_.rise[i - 1] + share * own_rise + (own.value - before) * share_rise;
  found_.slope[i] = covers ? Vec3(0.0) : slope;
  found_.top[i] = covers ? 0.0 : s;
}

}  // namespace palpate
