#pragma once
/// The C2 function that interpolates the voxels of an image near a surface.

#include <memory>
#include <optional>

#include "scan/band.h"

namespace palpate::vdb {

class BrickField;

/// The tri-cubic spline through a band's values (as by Sampler::kCubic), mapped by an affine.
/// Beyond the image's border the values continue mirrored and as outside: a shape that reaches the
/// border ends half a voxel beyond it.
class LatticeSpline {
 public:
  /// `axes` and `origin` place the voxels of the band's box, in the unit of all results. Values may
  /// have any scale.
  LatticeSpline(const Band& band, const Mask& mask, const Mat3& axes, const Vec3& origin);
  ~LatticeSpline();
  LatticeSpline(const LatticeSpline&) = delete;
  LatticeSpline& operator=(const LatticeSpline&) = delete;

  /// Value at an index of the band's box; nothing if the band does not contain the neighborhood.
  [[nodiscard]] std::optional<double> valueAt(const Vec3& index) const noexcept;

  /// The gradient there, by index; 0 where there is no value.
  [[nodiscard]] Vec3 slopeAt(const Vec3& index) const noexcept;

  struct Foot {
    Vec3 point{0.0, 0.0, 0.0};   ///< on the surface
    Vec3 normal{0.0, 0.0, 0.0};  ///< [-] unit, outward, there
    double distance = 0.0;       ///< distance of the query point; negative inside
  };
  /// The closest point to `p` near `start`, by Newton's method on q + m grad S(q) = p, S(q) = 0.
  /// Nothing if it does not converge.
  [[nodiscard]] std::optional<Foot> foot(const Vec3& p, const Vec3& start) const noexcept;

 private:
  std::unique_ptr<const BrickField> spline_;  ///< in voxels
  Mat3 axes_;
  Mat3 to_index_;
  Mat3 metric_;  ///< dot products of the axes
  Mat3 inverse_metric_;
  double metric_size_;  ///< its determinant
  Vec3 origin_;
  double shortest_;  ///< length of the shortest axis
};

}  // namespace palpate::vdb
