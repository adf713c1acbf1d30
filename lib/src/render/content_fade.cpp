#include "content_fade.h"

#include <cmath>

#include "palpate/interior/partition.h"
#include "region_thickness.h"

namespace palpate {
namespace {

/// Long enough that hovering in a mouth does not chatter, short against all that is in there: a
/// quarter of a millimeter in a bowl of 40 mm that is cut at 15 mm, whose largest ball has 55 mm.
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
