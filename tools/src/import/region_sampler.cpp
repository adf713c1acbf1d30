#include "import/region_sampler.h"

#include <cmath>

namespace palpate::tools {

RegionSampler::RegionSampler(const ImportedScan& scan)
    : scan_(scan), to_index_(glm::inverse(scan.labels.axes)) {
  for (std::size_t r = 0; r < scan.plan.regions.size(); ++r) {
    for (const int label : scan.plan.regions[r].labels) region_of_[label] = r;
  }
  for (std::size_t r = 0; r < scan.survey.outside(); ++r) {
    const Box3& bounds = scan.survey.regions[r].bounds;
    if (bounds.isEmpty()) continue;
    box_.include(bounds.lo);
    box_.include(bounds.hi);
  }
}

RegionSampler::Sample RegionSampler::at(const Vec3& world) const {
  const vdb::Image& image = scan_.labels;
  const Vec3 index = to_index_ * (world - image.origin);
  std::size_t at = 0;
  std::size_t stride = 1;
  bool is_at_border = false;
  for (int axis = 0; axis < 3; ++axis) {
    const int size = image.size[static_cast<std::size_t>(axis)];
    const double nearest = std::round(index[axis]);
    if (!(nearest >= 0.0 && nearest < size)) return {scan_.survey.outside(), true};
    const auto n = static_cast<std::size_t>(nearest);
    is_at_border = is_at_border || n == 0 || n + 1 == static_cast<std::size_t>(size);
    at += stride * n;
    stride *= static_cast<std::size_t>(size);
  }
  const auto found = region_of_.find(static_cast<int>(image.values[at]));
  if (found != region_of_.end()) return {found->second, is_at_border};
  const bool in_body = !scan_.body.empty() && scan_.body[at] != 0;
  return {in_body ? scan_.survey.gap() : scan_.survey.outside(), is_at_border};
}

}  // namespace palpate::tools
