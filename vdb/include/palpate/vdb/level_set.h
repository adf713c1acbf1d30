#pragma once
/// LevelSet: a narrow-band signed distance grid with its metadata, without OpenVDB in the header.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/core/progress.h"
#include "palpate/export.h"
#include "palpate/fields/field.h"

/// Grids: baked, read and written, certified, and read by the loop as fields and material maps;
/// with the readers of meshes and scans that they are made of.
namespace palpate::vdb {

/// Facts about a level set that need no pass over its voxels.
struct LevelSetInfo {
  std::string name;                             ///< grid name, `<layer>/surface`
  double voxel_size = 0.0;                      ///< [m]
  double half_width = 0.0;                      ///< [voxels] of the narrow band, each side
  std::uint64_t active_voxels = 0;              ///< those of the narrow band
  std::uint64_t memory = 0;                     ///< [bytes]
  Box3 bounds;                                  ///< [m] of the active voxels
  std::string length_unit;                      ///< of the file: "mm", "m", ...
  double meters_per_unit = 1.0;                 ///< [m]
  std::map<std::string, std::string> metadata;  ///< frame, layer, source, tolerance, ... as text
};

/// Shared handle on an immutable grid; copying is cheap.
class PALPATE_EXPORT LevelSet {
 public:
  struct Impl;  ///< holds the openvdb::FloatGrid; see palpate/vdb/openvdb_access.h

  LevelSet() = default;
  /// For the code that makes grids; null gives an empty handle.
  explicit LevelSet(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  /// False for an empty handle, which has no grid.
  [[nodiscard]] explicit operator bool() const noexcept { return impl_ != nullptr; }
  /// Must not be called on an empty handle; the same holds for impl().
  [[nodiscard]] const LevelSetInfo& info() const;
  /// The OpenVDB grid, for code that includes openvdb_access.h.
  [[nodiscard]] const Impl& impl() const { return *impl_; }

  /// The same grid under another name and with more metadata.
  [[nodiscard]] LevelSet named(std::string name,
                               const std::map<std::string, std::string>& more_metadata) const;

 private:
  std::shared_ptr<const Impl> impl_;
};

/// How a field reads its grid.
enum class Sampler {
  kCubic,  ///< haptic bricks: C2 tri-cubic B-spline with its own gradient and Hessian; the default
  kTrilinear,  ///< trilinear, from the same bricks: the gradient jumps from voxel to voxel
  kAccessor,   ///< trilinear by a plain OpenVDB accessor on the grid itself: no memory of its own
};

/// [voxels] The half width below which a band is too narrow for Sampler::kCubic: for a query within
/// a voxel of the surface the spline and its prefilter reach voxels up to 4.9 further off.
inline constexpr double kCubicHalfWidth = 6.0;

/// Whether a grid must be widened() before kCubic can read it. gridField() does so itself; call
/// this to tell the user.
[[nodiscard]] inline bool isTooNarrow(const LevelSetInfo& info) noexcept {
  // The background is a float, and may be a little below the width that was asked for.
  return info.half_width < kCubicHalfWidth - 1e-3;
}

/// The level set as a Field in [m]. The grid is copied into bricks (some 5.9 kB for 512 voxels; in
/// parallel), and not needed afterwards, except by kAccessor. For kCubic, a band that isTooNarrow()
/// is widened first.
///
/// A sample is in the band if all voxels it depends on are active. Outside the band the sample says
/// so: its sign is right, its gradient zero, and |value| a lower bound of the distance that never
/// exceeds the band's half width by more than the distance to the nearest voxel; where the bound
/// joins the band it may exceed the distance by the band's own error there. The function is
/// continuous everywhere (kCubic: C2).
///
/// metric() is kImplicit: between exact voxels the interpolant has an error (trilinear: voxel^2 / 8
/// times the curvatures; cubic: the fourth power of voxel times curvature), and its gradient's
/// length differs from 1. lipschitz() is measured from the voxels, and holds everywhere, across the
/// band's rim too.
///
/// If the grid reaches beyond the bounded box `within` [m], only the bricks that samples in the box
/// need are made, and the field is knownWithin() it; kAccessor keeps the grid as it is.
[[nodiscard]] PALPATE_EXPORT FieldPtr gridField(const LevelSet& grid,
                                                Sampler sampler = Sampler::kCubic,
                                                const Box3& within = Box3::everything());

/// [bytes] Memory that the samples of a field by gridField() are read from: its bricks with their
/// tables, or the grid for kAccessor. 0 for any other field.
[[nodiscard]] PALPATE_EXPORT std::uint64_t memoryOf(const Field& grid_field) noexcept;

/// The same grid with a band of `half_width` [voxels]; `grid` itself if it is as wide already. The
/// voxels of the old band keep their values. A new voxel holds the distance to the closest point of
/// the surface in the old band, found by Newton steps on a C2 spline through it.
/// @throws Error (kInput) if the old band is narrower than 2 voxels, kOperation for memory,
/// kCancelled.
[[nodiscard]] PALPATE_EXPORT LevelSet widened(const LevelSet& grid, double half_width,
                                              const Progress& progress = {});

}  // namespace palpate::vdb
