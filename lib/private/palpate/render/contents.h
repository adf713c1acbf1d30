#pragma once
/// The contents of a scene's regions as one renderer feels them: as the scene describes them,
/// except for what was changed while it runs.

#include <cstdint>
#include <vector>

#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene.h"

namespace palpate {

/// One entry for each region. Real-time safe except for the constructor.
class Contents {
 public:
  explicit Contents(const Scene& scene);

  /// Returns false, and changes nothing, for an unknown region or a value out of its range.
  [[nodiscard]] bool change(RegionId region, const ContentChange& change) noexcept;

  /// Null if nothing is felt there and no change can alter that.
  [[nodiscard]] const Material* material(RegionId region) const noexcept {
    return regions_[region].material;
  }
  /// [N s/m] at `p` [m]
  [[nodiscard]] double viscosity(RegionId region, const Vec3& p) const noexcept {
    const Region& r = regions_[region];
    if (r.change.viscosity) return *r.change.viscosity;
    return r.material != nullptr ? r.material->viscosity.at(p) : 0.0;
  }
  /// [m/s] at `p` [m]
  [[nodiscard]] Vec3 flow(RegionId region, const Vec3& p) const noexcept {
    const Region& r = regions_[region];
    if (r.change.flow) return *r.change.flow;
    return r.material != nullptr ? r.material->flow.at(p) : Vec3(0.0);
  }
  [[nodiscard]] bool hasLattice(RegionId region) const noexcept {
    return regions_[region].has_lattice;
  }
  /// [N] amplitude of the lattice's force at `p` [m]
  [[nodiscard]] MaterialMap::Sample latticeForce(RegionId region, const Vec3& p) const noexcept {
    const Region& r = regions_[region];
    if (r.change.lattice_force) return {*r.change.lattice_force, Vec3(0.0)};
    return r.material->lattice.force.sample(p);
  }
  /// [N] at `p` [m]
  [[nodiscard]] double cutting(RegionId region, const Vec3& p) const noexcept {
    const Region& r = regions_[region];
    if (r.change.cutting) return *r.change.cutting;
    return r.material != nullptr ? r.material->cutting.at(p) : 0.0;
  }
  /// Whether the region holds a needle: by cutting force, or along its shaft.
  [[nodiscard]] bool holdsNeedle(RegionId region) const noexcept {
    return regions_[region].holds_needle;
  }
  /// A number that grows with every change.
  [[nodiscard]] std::uint32_t version() const noexcept { return version_; }
  /// [m] Two paths of a needle that are closer than this count as one; it is about a needle's
  /// radius: 0.5 mm, or an eighth of the thickest tissue where that is less, so that it scales with
  /// the scene. Ports that make holes have their own radius.
  [[nodiscard]] double sameWay() const noexcept { return same_way_; }
  /// Whether any region holds a needle.
  [[nodiscard]] bool holdNeedles() const noexcept { return hold_needles_; }

 private:
  struct Region {
    const Material* material = nullptr;
    ContentChange change = {};
    bool has_lattice = false;
    bool holds_needle = false;
  };
  void look(Region& region) noexcept;

  std::vector<Region> regions_;
  bool hold_needles_ = false;
  double same_way_ = 0.0;
  std::uint32_t version_ = 0;
};

}  // namespace palpate
