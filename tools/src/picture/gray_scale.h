#pragma once
/// A scan's values as shades of gray.

#include <memory>

#include "palpate/vdb/image.h"

namespace palpate::tools {

/// From black at the 1st percentile of the voxels to white at the 99th; trilinear between them.
class GrayScale {
 public:
  /// Nothing has a shade if `image` is null, or has one value only.
  explicit GrayScale(std::shared_ptr<const vdb::Image> image);

  [[nodiscard]] bool hasShades() const noexcept { return image_ != nullptr; }
  /// From 0 to 1 at `p` [m]; NaN outside the box of the voxels' centers, and where one of the
  /// voxels around has no value.
  [[nodiscard]] double at(const Vec3& p) const noexcept;
  /// Whether `p` [m] is within the box of the voxels' centers.
  [[nodiscard]] bool covers(const Vec3& p) const noexcept { return isWithin(indexOf(p)); }

 private:
  [[nodiscard]] Vec3 indexOf(const Vec3& p) const noexcept { return to_index_ * (p - origin_); }
  [[nodiscard]] bool isWithin(const Vec3& index) const noexcept;

  std::shared_ptr<const vdb::Image> image_;
  Mat3 to_index_{1.0};
  Vec3 origin_{0.0, 0.0, 0.0};  ///< [m]
  double low_ = 0.0;
  double high_ = 1.0;
};

}  // namespace palpate::tools
