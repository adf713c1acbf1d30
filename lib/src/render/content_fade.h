#pragma once
/// The distance behind an opening at which a content is felt in full.

#include <vector>

#include "palpate/scene/scene.h"

namespace palpate {

/// Made together with a renderer; real-time safe afterwards.
class ContentFade {
 public:
  explicit ContentFade(const Scene& scene);

  /// [m] Measured behind the surface of `mouth` in `region`: a share of the thickness of the
  /// region, or of the surface's own feature size where the region has no end. So it scales with
  /// the scene, and the content of a thin film is felt as well as that of a bowl.
  [[nodiscard]] double length(RegionId region, LeafId mouth) const noexcept;

 private:
  const Scene& scene_;
  std::vector<double> thickness_;  ///< [m] by region: diameter of the largest ball found in it
};

}  // namespace palpate
