#include "view/gray_slices.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "json_parts.h"
#include "palpate/vdb/text.h"
#include "picture/gray_scale.h"

namespace palpate::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "slices travel as they are in memory");

constexpr std::uint8_t kBlack = 1;
constexpr double kShades = 254.0;  // from black to white

/// The box around the centers of all voxels.
Box3 boxOf(const vdb::Image& image) {
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index(0.0);
    for (int i = 0; i < 3; ++i) {
      if (((corner >> i) & 1) != 0) index[i] = image.size[static_cast<std::size_t>(i)] - 1.0;
    }
    box.include(image.toWorld(index));
  }
  return box;
}

double finestSpacing(const vdb::Image& image) {
  return std::min(
      {glm::length(image.axes[0]), glm::length(image.axes[1]), glm::length(image.axes[2])});
}

void append(std::string& bytes, std::size_t number) {
  const auto value = static_cast<std::uint32_t>(number);
  std::array<char, sizeof value> raw{};
  std::memcpy(raw.data(), &value, sizeof value);
  bytes.append(raw.data(), raw.size());
}

}  // namespace

GraySlices::GraySlices(const std::shared_ptr<const vdb::Image>& image, const Box3& view,
                       const std::function<bool()>& is_wanted) {
  const GrayScale scale(image);
  if (!scale.hasShades()) return;
  source_ = vdb::fileName(image->source);
  // Half a voxel more, so that points are the voxels' centers unless `view` cuts the box.
  const double finest = finestSpacing(*image);
  box_ = boxOf(*image).grownBy(0.5 * finest).intersectedWith(view);
  const Vec3 size = box_.size();
  const double longest = std::max({size.x, size.y, size.z});
  if (box_.isEmpty() || !(longest > 0.0)) return;
  step_ = std::max(finest, longest / kLongest);
  for (int i = 0; i < 3; ++i) {
    const double cells = std::clamp(std::round(size[i] / step_), 1.0, double{kLongest});
    size_[static_cast<std::size_t>(i)] = static_cast<std::size_t>(cells);
    // Cells are cubes. The box becomes longer or shorter to hold whole cells, equally at both ends.
    const double spare = 0.5 * (size[i] - cells * step_);
    box_.lo[i] += spare;
    box_.hi[i] -= spare;
  }
  shades_.resize(size_[0] * size_[1] * size_[2]);
  bool has_any = false;
  for (Index i{}; i[2] < size_[2] && is_wanted(); ++i[2]) {
    for (i[1] = 0; i[1] < size_[1]; ++i[1]) {
      for (i[0] = 0; i[0] < size_[0]; ++i[0]) {
        const Vec3 p = box_.lo + step_ * (Vec3(0.5) + Vec3(static_cast<double>(i[0]),
                                                           static_cast<double>(i[1]),
                                                           static_cast<double>(i[2])));
        const double shade = scale.at(p);
        if (std::isnan(shade)) continue;
        shades_[at(i)] = static_cast<std::uint8_t>(kBlack + std::lround(kShades * shade));
        has_any = true;
      }
    }
  }
  if (!has_any) shades_.clear();
}

Json GraySlices::json() const {
  return {{"file", source_}, {"box", boxJson(box_)}, {"counts", size_}};
}

std::optional<std::string> GraySlices::slice(std::size_t axis, std::size_t index) const {
  if (isEmpty() || axis >= 3 || index >= size_[axis]) return std::nullopt;
  const std::size_t u = axis == 0 ? 1 : 0;
  const std::size_t v = axis == 2 ? 1 : 2;
  std::string bytes = "PSLC";
  bytes.reserve(12 + size_[u] * size_[v]);
  append(bytes, size_[u]);
  append(bytes, size_[v]);
  Index i{};
  i[axis] = index;
  for (i[v] = 0; i[v] < size_[v]; ++i[v]) {
    for (i[u] = 0; i[u] < size_[u]; ++i[u]) bytes.push_back(static_cast<char>(shades_[at(i)]));
  }
  return bytes;
}

}  // namespace palpate::tools
