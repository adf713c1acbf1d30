#pragma once
/// How far behind an opening a content is felt in full.

#include <vector>

#include "palpate/scene/scene.h"

namespace palpate {

/// Made when a renderer is; then real-time safe.
class ContentFade {
 public:
  explicit ContentFade(const Scene& scene);

  /// [m] Behind the surface of `mouth` in `region`: a share of how thick the region is, or of the
  /// surface's own feature size where the region has no end. So a scene in micrometers is the same
  /// scene, and a film is felt as well as a bowl.
  [[nodiscard]] double length(RegionId region, LeafId mouth) const noexcept;

 private:
  const Scene& scene_;
  std::vector<double> thickness_;  ///< [m] by region: of the largest ball seen in it
};

}  // namespace palpate
