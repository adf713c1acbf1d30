#include "support/rivals/voxel_grid.h"

#include <algorithm>
#include <cmath>

namespace palpate::rivals {
namespace {

/// Interpolates over the eight voxels around a point.
template <typename Value, typename F>
Value interpolated(const Vec3& at, Value sum, F&& f) {
  const Vec3 low = glm::floor(at);
  const Vec3 t = at - low;
  for (int n = 0; n < 8; ++n) {
    const int dx = n & 1;
    const int dy = n >> 1 & 1;
    const int dz = n >> 2 & 1;
    const double share =
        (dx != 0 ? t.x : 1.0 - t.x) * (dy != 0 ? t.y : 1.0 - t.y) * (dz != 0 ? t.z : 1.0 - t.z);
    sum += share * f(static_cast<int>(low.x) + dx, static_cast<int>(low.y) + dy,
                     static_cast<int>(low.z) + dz);
  }
  return sum;
}

}  // namespace

VoxelGrid::VoxelGrid(const Field& field, const Box3& box, const Voxels& voxels)
    : lo_(box.lo), size_(voxels.size), kind_(voxels.gradient) {
  for (int axis = 0; axis < 3; ++axis) {
    count_[static_cast<std::size_t>(axis)] =
        static_cast<int>(std::ceil(box.size()[axis] / size_)) + 1;
  }
  values_.reserve(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                  static_cast<std::size_t>(count_[2]));
  for (int z = 0; z < count_[2]; ++z) {
    for (int y = 0; y < count_[1]; ++y) {
      for (int x = 0; x < count_[0]; ++x) {
        const double s = field.value(lo_ + size_ * Vec3(x, y, z));
        const double full = voxels.ramp > 0.0
                                ? std::clamp(0.5 - s / (voxels.ramp * size_), 0.0, 1.0)
                                : (s < 0.0 ? 1.0 : 0.0);
        values_.push_back(static_cast<float>(full));
      }
    }
  }
}

double VoxelGrid::at(int x, int y, int z) const noexcept {
  const auto kept = [&](int i, std::size_t axis) { return std::clamp(i, 0, count_[axis] - 1); };
  const std::size_t index =
      (static_cast<std::size_t>(kept(z, 2)) * static_cast<std::size_t>(count_[1]) +
       static_cast<std::size_t>(kept(y, 1))) *
          static_cast<std::size_t>(count_[0]) +
      static_cast<std::size_t>(kept(x, 0));
  return static_cast<double>(values_[index]);
}

double VoxelGrid::value(const Vec3& p) const noexcept {
  return interpolated((p - lo_) / size_, 0.0, [&](int x, int y, int z) { return at(x, y, z); });
}

Vec3 VoxelGrid::central(const Index& i) const noexcept {
  return Vec3(at(i[0] + 1, i[1], i[2]) - at(i[0] - 1, i[1], i[2]),
              at(i[0], i[1] + 1, i[2]) - at(i[0], i[1] - 1, i[2]),
              at(i[0], i[1], i[2] + 1) - at(i[0], i[1], i[2] - 1)) /
         (2.0 * size_);
}

Vec3 VoxelGrid::sobel(const Index& i) const noexcept {
  // A central difference along each axis, smoothed by weights 1 2 1 along the other two.
  Vec3 sum(0.0);
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const double v = at(i[0] + dx, i[1] + dy, i[2] + dz);
        const double wx = 2.0 - std::abs(dx);
        const double wy = 2.0 - std::abs(dy);
        const double wz = 2.0 - std::abs(dz);
        sum += v * Vec3(dx * wy * wz, dy * wx * wz, dz * wx * wy);
      }
    }
  }
  return sum / (32.0 * size_);
}

Vec3 VoxelGrid::gradient(const Vec3& p) const noexcept {
  const Vec3 at = (p - lo_) / size_;
  if (kind_ == Voxels::Gradient::kInterpolated) {
    return interpolated(at, Vec3(0.0), [&](int x, int y, int z) { return central({x, y, z}); });
  }
  const Vec3 nearest = glm::floor(at + 0.5);
  const Index i{static_cast<int>(nearest.x), static_cast<int>(nearest.y),
                static_cast<int>(nearest.z)};
  return kind_ == Voxels::Gradient::kSobel ? sobel(i) : central(i);
}

}  // namespace palpate::rivals
