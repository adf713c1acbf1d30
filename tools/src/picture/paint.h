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
#include "picture/gray_scale.h"

namespace palpate::tools {

class Paint {
 public:
  /// Without an image: plain colors.
  /// `colors`, by the names of regions, take precedence over the palette.
  Paint(std::shared_ptr<const vdb::Image> image, const Scene& scene,
        const std::map<std::string, vdb::LabelColor>& colors);

  [[nodiscard]] Color at(RegionId region, const Vec3& p) const;
  /// The region's color without gray values.
  [[nodiscard]] Color of(RegionId region) const { return colors_.at(region); }
  /// Whether there is a gray value at `p` [m].
  [[nodiscard]] bool isInImage(const Vec3& p) const { return gray_.covers(p); }
  [[nodiscard]] bool hasImage() const noexcept { return gray_.hasShades(); }

 private:
  std::vector<Color> colors_;  ///< by region
  GrayScale gray_;
};

}  // namespace palpate::tools
