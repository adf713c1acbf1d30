#pragma once
/// Finds defects in the grids of a .vdb file.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/core/progress.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/io.h"

namespace palpate::vdb {

/// |gradient| by central differences at the active voxels whose six neighbors are active. It is 1
/// wherever values are distances, less at edges and medial axes.
struct GradientStatistics {
  std::uint64_t voxels = 0;  ///< that were measured
  double mean = 0.0;
  double deviation = 0.0;  ///< RMS of the difference to 1
  double worst = 1.0;      ///< the value farthest from 1
  Vec3 worst_place{0.0};   ///< [m]
};

/// Number of voxels with one kind of defect, and the place of one of them.
struct VoxelDefect {
  std::uint64_t voxels = 0;
  Vec3 place{0.0};  ///< [m]
};

struct GridCheck {
  VdbGridSummary grid;
  std::optional<Problem> refused;  ///< why readVdb() does not take it
  /// Whether the following fields were filled in: only for floats that are, or may be, signed
  /// distances.
  bool has_distances = false;
  VoxelDefect not_finite;
  GradientStatistics gradient;
  std::uint64_t inside_voxels = 0;  ///< active and negative
  /// Where inside and outside meet without a band in between: a positive voxel is next to a
  /// negative one, and one of the two is not active. A band ends this way if its inside holds the
  /// outside's background, or if it was cut off.
  VoxelDefect sign_breaks;
  /// Active voxels more than a voxel and a half within the band, with a neighbor that is not
  /// active.
  VoxelDefect band_holes;
  double volume = 0.0;  ///< [m^3] of the negative region, voxels on the surface by their share
  /// Unless the grid is refused, for the cubic sampler: why contact would not take the grid,
  std::optional<Problem> uncertified;
  /// or else the certificate that contact relies on, and the repairs that this took.
  std::optional<BandCertificate> certificate;
  std::vector<std::string> repairs;
};

/// [m^3] of the negative region, voxels on the surface by their share.
[[nodiscard]] double solidVolume(const LevelSet& grid);

/// A level set with corrected signs inside, and how many voxels changed.
struct MarkedInside {
  LevelSet grid;
  std::uint64_t voxels = 0;  ///< not active, and now on the other side than before
};

/// Mends the sign breaks of GridCheck: every voxel that is not active takes the side of the part of
/// the band that encloses it. The band itself is kept, bit by bit. Without sign breaks, `grid`
/// itself.
/// @throws Error (kInput, vdb.torn) naming a place where the band has a hole, or was cut off, so
/// that inside and outside are connected; `path` is the file to name.
[[nodiscard]] MarkedInside withInsideMarked(const LevelSet& grid, const std::string& path = {});

/// Every grid of the file; or only `name`, if it is not empty. Lengths of a grid without a unit are
/// in `unit_if_missing`, or taken as [m] if that is empty too.
/// @throws Error (kInput): a file that cannot be read, or has no such grid; kCancelled.
[[nodiscard]] std::vector<GridCheck> checkVdb(const std::string& path, const std::string& name = {},
                                              const std::string& unit_if_missing = {},
                                              UnknownClass unknown_class = UnknownClass::kRefuse,
                                              const Progress& progress = {});

}  // namespace palpate::vdb
