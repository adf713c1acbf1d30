#pragma once
/// LevelSet: a narrow-band signed distance grid with its metadata, without OpenVDB in the header.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/core/progress.h"
#include "palpate/fields/field.h"

namespace palpate::vdb {

/// What is known of a level set without looking at its voxels one by one.
struct LevelSetInfo {
  std::string name;         ///< grid name, `<layer>/surface`
  double voxel_size = 0.0;  ///< [m]
  double half_width = 0.0;  ///< [voxels] of the narrow band, each side
  std::uint64_t active_voxels = 0;
  std::uint64_t memory = 0;                     ///< [bytes]
  Box3 bounds;                                  ///< [m] of the active voxels
  std::string length_unit;                      ///< of the file: "mm", "m", ...
  double metres_per_unit = 1.0;                 ///< [m]
  std::map<std::string, std::string> metadata;  ///< frame, layer, source, tolerance, ... as text
};

/// Shared handle on an immutable grid; copying is cheap.
class LevelSet {
 public:
  struct Impl;  ///< holds the openvdb::FloatGrid; see palpate/vdb/openvdb_access.h

  LevelSet() = default;
  explicit LevelSet(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  [[nodiscard]] explicit operator bool() const noexcept { return impl_ != nullptr; }
  [[nodiscard]] const LevelSetInfo& info() const;
  [[nodiscard]] const Impl& impl() const { return *impl_; }

  /// The same grid under another name and with more metadata.
  [[nodiscard]] LevelSet named(std::string name,
                               const std::map<std::string, std::string>& more_metadata) const;

 private:
  std::shared_ptr<const Impl> impl_;
};

/// The level set as a Field in [m]. Trilinear: value and its own gradient from the same eight voxels,
/// in some 50 ns; in the band if all eight are active. Out of the band the sample says so: the
/// sign is right, the gradient zero, and |value| a lower bound of the distance that never exceeds the
/// band's half width by more than the way to the nearest voxel.
///
/// metric() is kImplicit: between exact voxels the interpolant is off by up to voxel^2 / 8 of the
/// curvatures, either way, and its gradient's length differs from 1. lipschitz() is measured from the
/// voxels, and holds everywhere, across the band's rim too.
[[nodiscard]] FieldPtr gridField(const LevelSet& grid);

}  // namespace palpate::vdb
