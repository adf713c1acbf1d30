#include "picture/paint.h"

#include <cmath>
#include <utility>

#include "picture/palette.h"

namespace palpate::tools {
namespace {

/// Weight of the scan's gray values outside all layers.
constexpr double kOutsideGray = 0.5;

}  // namespace

Paint::Paint(std::shared_ptr<const vdb::Image> image, const Scene& scene,
             const std::map<std::string, vdb::LabelColor>& colors)
    : gray_(std::move(image)) {
  for (std::size_t i = 0; i < scene.regions().size(); ++i) {
    const auto own = colors.find(scene.regions()[i].name);
    colors_.push_back(own == colors.end()
                          ? regionColor(static_cast<RegionId>(i))
                          : Color{own->second[0], own->second[1], own->second[2], 1.0});
  }
}

Color Paint::at(RegionId region, const Vec3& p) const {
  const Color base = of(region);
  const double gray = gray_.at(p);
  if (std::isnan(gray)) return base;
  if (region == kOutside) return mixed(base, rgb(0x8D8D93), kOutsideGray * gray);
  const Color shaded = scaled(base, 0.30 + 0.85 * gray);
  return mixed(shaded, Color{gray, gray, gray}, 0.25);
}

}  // namespace palpate::tools
