#include "picture/paint.h"

#include <algorithm>
#include <cmath>

#include "picture/palette.h"

namespace palpate::tools {
namespace {

constexpr std::size_t kMostSampled = 200'000;
/// Weight of the scan's gray values outside all layers.
constexpr double kOutsideGray = 0.5;

}  // namespace

Paint::Paint(std::shared_ptr<const vdb::Image> image, const Scene& scene,
             const std::map<std::string, vdb::LabelColor>& colors)
    : image_(std::move(image)) {
  for (std::size_t i = 0; i < scene.regions().size(); ++i) {
    const auto own = colors.find(scene.regions()[i].name);
    colors_.push_back(own == colors.end()
                          ? regionColor(static_cast<RegionId>(i))
                          : Color{own->second[0], own->second[1], own->second[2], 1.0});
  }
  if (!image_) return;
  to_index_ = glm::inverse(image_->axes);
  std::vector<float> values;
  const std::size_t step = image_->values.size() / kMostSampled + 1;
  for (std::size_t i = 0; i < image_->values.size(); i += step) {
    if (std::isfinite(image_->values[i])) values.push_back(image_->values[i]);
  }
  if (values.empty()) {
    image_ = nullptr;
    return;
  }
  std::sort(values.begin(), values.end());
  low_ = values[values.size() / 100];
  high_ = values[values.size() - 1 - values.size() / 100];
  if (!(high_ > low_)) image_ = nullptr;
}

Color Paint::at(RegionId region, const Vec3& p) const {
  const Color base = of(region);
  if (!image_) return base;
  // Image::interpolate inverts the affine for each call, which is too slow for a million pixels.
  const Vec3 index = to_index_ * (p - image_->origin);
  int lower[3];
  double share[3];
  for (int i = 0; i < 3; ++i) {
    const double top = image_->size[static_cast<std::size_t>(i)] - 1.0;
    if (!(index[i] >= 0.0 && index[i] <= top)) return base;
    lower[i] = std::clamp(static_cast<int>(index[i]), 0, std::max(0, static_cast<int>(top) - 1));
    share[i] = index[i] - lower[i];
  }
  double gray = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    int at[3];
    for (int i = 0; i < 3; ++i) {
      const bool up = ((corner >> i) & 1) != 0;
      weight *= up ? share[i] : 1.0 - share[i];
      at[i] = std::min(lower[i] + (up ? 1 : 0), image_->size[static_cast<std::size_t>(i)] - 1);
    }
    if (weight > 0.0) gray += weight * image_->at(at[0], at[1], at[2]);
  }
  gray = std::clamp((gray - low_) / (high_ - low_), 0.0, 1.0);
  if (region == kOutside) return mixed(base, rgb(0x8D8D93), kOutsideGray * gray);
  const Color shaded = scaled(base, 0.30 + 0.85 * gray);
  return mixed(shaded, Color{gray, gray, gray}, 0.25);
}

bool Paint::isInImage(const Vec3& p) const {
  if (!image_) return false;
  const Vec3 index = to_index_ * (p - image_->origin);
  for (int i = 0; i < 3; ++i) {
    if (!(index[i] >= 0.0 && index[i] <= image_->size[static_cast<std::size_t>(i)] - 1.0))
      return false;
  }
  return true;
}

}  // namespace palpate::tools
