#pragma once
/// Field: the one interface through which every shape, analytic or from a grid, is felt.

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate {

/// One evaluation of a scalar field. Value and gradient come together because contact always needs
/// both, and because a narrow-band grid reads the same voxels for both.
struct FieldSample {
  double value = 0.0;            ///< [m] negative inside, zero on the surface, positive outside
  Vec3 gradient{0.0, 0.0, 0.0};  ///< [-] d value / d position, in the frame of the query
  /// false: |value| is only a lower bound of the distance with the right sign, and the gradient is
  /// zero (grids, far away)
  bool in_band = true;
};

/// A sample with its curvature.
struct FieldJet {
  double value = 0.0;            ///< [m]
  Vec3 gradient{0.0, 0.0, 0.0};  ///< [-]
  Mat3 hessian{0.0};             ///< [1/m] symmetric
  bool in_band = true;           ///< as in FieldSample; outside the band the Hessian is zero too
};

/// Points whose values are asked for together, so that the work on them can share instructions: a
/// cube of 4^3 voxels, for example. Unused entries may be any finite point.
struct PointBatch {
  /// Number of points.
  static constexpr std::size_t kCount = 64;
  std::array<double, kCount> x,  ///< [m] the field's frame
      y,                         ///< [m] the same
      z;                         ///< [m] the same

  /// [m] Point `n`, from 0, in the field's frame.
  [[nodiscard]] Vec3 operator[](std::size_t n) const noexcept { return {x[n], y[n], z[n]}; }
};
using ValueBatch = std::array<double, PointBatch::kCount>;  ///< [m]

/// What |value| means. Contact reads this once, when the scene is compiled.
enum class Metric {
  kExact,     ///< Euclidean distance to the surface; |gradient| = 1 almost everywhere
  kBound,     ///< never more than the distance (min and max of exact fields)
  kImplicit,  ///< only sign and zero set count; the distance is about |value| / |gradient|
};

class Field;
using FieldPtr = std::shared_ptr<const Field>;  ///< shared and unchanging, never null in a scene

/// How a field is put together, so that CSG can be taken apart into its smooth leaves. The span
/// `operands` points into the field that was asked and is valid as long as that field lives.
struct FieldStructure {
  /// The operation at the root of the field.
  enum class Kind {
    kLeaf,          ///< smooth, or not to be taken apart
    kUnion,         ///< min of the operands
    kIntersection,  ///< max of the operands
    kComplement,    ///< minus the operand
    kTransform,     ///< the operand, moved
    /// the part that all operands, which are smooth, have in common; the field's own value is
    /// better than their max (a box: its exact distance, where operands are six half-spaces)
    kFaces,
  };
  Kind kind = Kind::kLeaf;               ///< how the operands are combined
  std::span<const FieldPtr> operands{};  ///< none for a leaf; one for complement and transform
  Pose pose{};                           ///< transform only: operand frame -> this field's frame
};

/// A closed solid as a scalar field: S < 0 inside, S > 0 outside, S = 0 on the surface.
///
/// Thread safety: immutable after construction; any number of threads may sample one field.
/// Real time:     the const noexcept members never allocate, lock, throw or block.
class PALPATE_EXPORT Field {
 public:
  virtual ~Field() = default;

  /// Value and gradient at `p` [m, the field's frame]. Where the gradient is not defined (a
  /// sphere's center, a box's edge) it is one fixed unit vector of the generalized gradient; never
  /// NaN for finite `p`. For a non-finite `p` the value is NaN or infinite and must not be used.
  [[nodiscard]] virtual FieldSample sample(const Vec3& p) const noexcept = 0;

  /// Value alone [m]. Override it if that is cheaper than sample().
  [[nodiscard]] virtual double value(const Vec3& p) const noexcept { return sample(p).value; }

  /// value() of each point, bit for bit. Override it if many at once are cheaper than one by one.
  virtual void values(const PointBatch& points, ValueBatch& out) const noexcept;

  /// Value, gradient and Hessian. The base version takes finite differences of the gradient over a
  /// step that is a small share of featureSize().
  [[nodiscard]] virtual FieldJet jet(const Vec3& p) const noexcept;

  /// A box that holds every point with value <= 0 [m]; may be infinite.
  [[nodiscard]] virtual Box3 bounds() const noexcept = 0;

  /// How to read the field's value; never changes.
  [[nodiscard]] virtual Metric metric() const noexcept = 0;

  /// L with |S(a) - S(b)| <= L |a - b| for a, b in lipschitzDomain(). 1 for exact and bound fields.
  [[nodiscard]] virtual double lipschitz() const noexcept = 0;

  /// Where lipschitz() holds [m]; everything unless a field says otherwise.
  [[nodiscard]] virtual Box3 lipschitzDomain() const noexcept { return Box3::everything(); }

  /// Length [m] that tolerances are relative to: the smallest radius of curvature or thickness of
  /// the shape, or the voxel size of a grid. Positive and finite.
  [[nodiscard]] virtual double featureSize() const noexcept = 0;

  /// True if the surface is one plane and S the distance to it, everywhere. A plane has no natural
  /// size, so featureSize() then returns a stand-in.
  [[nodiscard]] virtual bool isFlat() const noexcept { return false; }

  /// The default is a leaf.
  [[nodiscard]] virtual FieldStructure structure() const noexcept { return {}; }
};

}  // namespace palpate
