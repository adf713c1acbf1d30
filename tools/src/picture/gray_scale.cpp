#include "picture/gray_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace palpate::tools {
namespace {

constexpr std::size_t kMostSampled = 200'000;
constexpr double kRounding = 1e-6;  // [voxels]

}  // namespace

GrayScale::GrayScale(std::shared_ptr<const vdb::Image> image) : image_(std::move(image)) {
  if (!image_) return;
  to_index_ = glm::inverse(image_->axes);
  origin_ = image_->origin;
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

double GrayScale::at(const Vec3& p) const noexcept {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!image_) return kNone;
  // Image::interpolate inverts the affine every time; here are a million pixels.
  const Vec3 index = indexOf(p);
  if (!isWithin(index)) return kNone;
  int lower[3];
  double share[3];
  for (int i = 0; i < 3; ++i) {
    const int top = image_->size[static_cast<std::size_t>(i)] - 1;
    const double within = std::clamp<double>(index[i], 0.0, top);
    lower[i] = std::clamp(static_cast<int>(within), 0, std::max(0, top - 1));
    share[i] = within - lower[i];
  }
  double value = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    int at[3];
    for (int i = 0; i < 3; ++i) {
      const bool up = ((corner >> i) & 1) != 0;
      weight *= up ? share[i] : 1.0 - share[i];
      at[i] = std::min(lower[i] + (up ? 1 : 0), image_->size[static_cast<std::size_t>(i)] - 1);
    }
    // A voxel whose weight is only a rounding error may have no value.
    if (weight > kRounding) value += weight * image_->at(at[0], at[1], at[2]);
  }
  if (std::isnan(value)) return kNone;
  return std::clamp((value - low_) / (high_ - low_), 0.0, 1.0);
}

bool GrayScale::isWithin(const Vec3& index) const noexcept {
  if (!image_) return false;
  for (int i = 0; i < 3; ++i) {
    const double top = image_->size[static_cast<std::size_t>(i)] - 1.0;
    if (!(index[i] >= -kRounding && index[i] <= top + kRounding)) return false;
  }
  return true;
}

}  // namespace palpate::tools
