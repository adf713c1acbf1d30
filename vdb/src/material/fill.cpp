#include "material/fill.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace palpate::vdb {
namespace {

/// The neighbors of a voxel across its faces.
class Neighbors {
 public:
  explicit Neighbors(const std::array<int, 3>& size)
      : size_{static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[1]),
              static_cast<std::size_t>(size[2])} {}

  template <typename F>
  void forEach(std::size_t voxel, F&& f) const {
    std::size_t rest = voxel;
    std::size_t stride = 1;
    for (const std::size_t length : size_) {
      const std::size_t at = rest % length;
      rest /= length;
      if (at > 0) f(voxel - stride);
      if (at + 1 < length) f(voxel + stride);
      stride *= length;
    }
  }

 private:
  std::array<std::size_t, 3> size_;
};

}  // namespace

bool fillUnknown(const std::array<int, 3>& size, std::vector<float>& values) {
  const Neighbors neighbors(size);
  // The voxels of a ring are marked when they are found, and get their values together, so that no
  // voxel counts as a neighbor of another one in its ring.
  std::vector<std::size_t> ring;
  std::vector<bool> found(values.size(), false);
  bool any_known = false;
  const auto reach = [&](std::size_t voxel) {
    if (!std::isnan(values[voxel]) || found[voxel]) return;
    found[voxel] = true;
    ring.push_back(voxel);
  };
  for (std::size_t voxel = 0; voxel < values.size(); ++voxel) {
    if (std::isnan(values[voxel])) continue;
    any_known = true;
    neighbors.forEach(voxel, reach);
  }
  std::vector<float> means;
  while (!ring.empty()) {
    means.clear();
    for (const std::size_t voxel : ring) {
      double sum = 0.0;
      int count = 0;
      neighbors.forEach(voxel, [&](std::size_t other) {
        if (std::isnan(values[other])) return;
        sum += static_cast<double>(values[other]);
        ++count;
      });
      means.push_back(static_cast<float>(sum / count));
    }
    const std::vector<std::size_t> filled = std::exchange(ring, {});
    for (std::size_t i = 0; i < filled.size(); ++i) values[filled[i]] = means[i];
    for (const std::size_t voxel : filled) neighbors.forEach(voxel, reach);
  }
  return any_known;
}

}  // namespace palpate::vdb
