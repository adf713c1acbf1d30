#include "palpate/render/contents.h"

#include <cmath>

namespace palpate {
namespace {

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
