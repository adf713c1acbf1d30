#pragma once
/// The color of a point on a cut face: that of its region, made darker or lighter by a scan's gray
/// values.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "palpate/scene/scene.h"
#include "palpate/vdb/image.h"
#include "picture/canvas.h"

namespace palpate::tools {

class Paint {
 public:
  /// Without an image: plain colors. Gray ranges from the 1st to the 99th percentile of the voxels.
  /// `colors`, by the names of regions, take precedence over the palette.
  Paint(std::shared_ptr<const vdb::Image> image, const Scene& scene,
        const std::map<std::string, vdb::LabelColor>& colors);

  [[nodiscard]] Color at(RegionId region, const Vec3& p) const;
  /// The region's color without gray values.
  [[nodiscard]] Color of(RegionId region) const { return colors_.at(region); }
  /// Whether there is a gray value at `p` [m].
  [[nodiscard]] bool isInImage(const Vec3& p) const;
  [[nodiscard]] bool hasImage() const noexcept { return image_ != nullptr; }

 private:
  std::vector<Color> colors_;  ///< by region
  std::shared_ptr<const vdb::Image> image_;
  Mat3 to_index_{1.0};
  double low_ = 0.0;
  double high_ = 1.0;
};

}  // namespace palpate::tools
