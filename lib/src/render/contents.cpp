#include "palpate/render/contents.h"

#include <algorithm>
#include <cmath>

#include "region_thickness.h"

namespace palpate {
namespace {

constexpr double kWidestWay = 0.5e-3;  // [m]
/// Share of the thickness of the thickest tissue.
constexpr double kWayShare = 0.125;

bool isFrom0(const std::optional<double>& value, double most = kInfinity) noexcept {
  return !value || (std::isfinite(*value) && *value >= 0.0 && *value <= most);
}

}  // namespace

Contents::Contents(const Scene& scene) : regions_(scene.regions().size()) {
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const int content = scene.regions()[i].content;
    if (content >= 0) {
      regions_[i].material = &scene.materials()[static_cast<std::size_t>(content)];
    }
    look(regions_[i]);
  }
  // A content with a stiffness that does not hold a needle yet may hold one after setContent().
  double thickest = 0.0;
  for (std::size_t i = 0; i < regions_.size() && kWayShare * thickest < kWidestWay; ++i) {
    const Material* own = regions_[i].material;
    if (own == nullptr || !(regions_[i].holds_needle || own->stiffness.range().most > 0.0))
      continue;
    const palpate::Region& region = scene.regions()[i];
    double thickness = kInfinity;
    if (region.has_seed && region.field != nullptr) thickness = thicknessOf(scene.regions(), i);
    thickest = std::max(thickest, thickness);
  }
  same_way_ = std::min(kWidestWay, kWayShare * thickest);
}

bool Contents::change(RegionId region, const ContentChange& change) noexcept {
  if (region >= regions_.size()) return false;
  Region& own = regions_[region];
  const double stiffness = own.material != nullptr ? own.material->stiffness.range().least : 0.0;
  const double highest = own.material != nullptr && own.material->lattice.hasWaves()
                             ? own.material->lattice.highestForce(stiffness)
                             : 0.0;
  if (!isFrom0(change.viscosity) || !isFrom0(change.lattice_force, highest) ||
      !isFrom0(change.cutting, stiffness > 0.0 ? kInfinity : 0.0) ||
      (change.flow && !isFinite(*change.flow))) {
    return false;
  }
  own.change = change;
  ++version_;
  look(own);
  return true;
}

bool canChangeContent(const Scene& scene, RegionId region, const ContentChange& change) {
  return Contents(scene).change(region, change);
}

void Contents::look(Region& region) noexcept {
  const Material* material = region.material;
  const auto most = [](const std::optional<double>& changed, const Parameter& parameter) {
    return changed ? *changed : parameter.range().most;
  };
  region.has_lattice =
      material != nullptr && most(region.change.lattice_force, material->lattice.force) > 0.0;
  region.holds_needle =
      material != nullptr &&
      (most(region.change.cutting, material->cutting) > 0.0 || material->shaft.stiffness > 0.0);
  hold_needles_ = hold_needles_ || region.holds_needle;
}

}  // namespace palpate
