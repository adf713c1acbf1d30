#include "content_fade.h"

#include <cmath>

#include "palpate/interior/partition.h"
#include "region_thickness.h"

namespace palpate {
namespace {

/// Share of the thickness. It is large enough that hovering in a mouth does not chatter, and small
/// compared with the region: a quarter of a millimeter in a bowl of 40 mm radius that is cut at 15
/// mm, in which the largest ball has a diameter of 55 mm.
constexpr double kShare = 1.0 / 220.0;

}  // namespace

ContentFade::ContentFade(const Scene& scene)
    : scene_(scene), thickness_(scene.regions().size(), kInfinity) {
  for (std::size_t i = 0; i < thickness_.size(); ++i) {
    const Region& region = scene.regions()[i];
    if (!region.has_seed || region.field == nullptr) continue;
    thickness_[i] = thicknessOf(scene.regions(), i);
  }
}

double ContentFade::length(RegionId region, LeafId mouth) const noexcept {
  const double thickness = thickness_[region];
  return kShare *
         (std::isfinite(thickness) ? thickness : scene_.partition().leaves()[mouth].feature);
}

}  // namespace palpate
