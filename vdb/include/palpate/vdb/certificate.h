#pragma once
/// What contact relies on in a grid, made sure of once and for every point between its voxels.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/core/progress.h"
#include "palpate/export.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Of a grid as one Sampler reads it (kAccessor: as kTrilinear). Bounds come from the spline's
/// coefficients, not from samples.
struct BandCertificate {
  Sampler sampler = Sampler::kCubic;  ///< the sampler that the numbers hold for
  double within =
      0.0;  ///< [m] every point that near to the surface answers with value and gradient
  double lipschitz =
      1.0;  ///< [-] of what is sampled, everywhere; some 4 where distances to all sides meet
  double steepest = 1.0;  ///< [-] no slope is above where |value| is below 1.5 voxels
  /// [-] In each cell that may hold the surface the value grows at least so fast along some
  /// direction. Not above 0: there is an edge, a cusp or a part as thin as the cell.
  double slope = 1.0;
  Vec3 slope_place{0.0};  ///< [m] where that is
  double rough = 0.0;     ///< [-] share of these cells in which it may be below 0.4
  /// [m] How far the surface that is felt is off the one that was meant, where it is smooth over
  /// some four voxels: the sampler's error, and what a voxel can be off without a contradiction to
  /// its neighbors, if others made the grid.
  double off = 0.0;
  std::string content;  ///< contentHash() of the grid that it is of
};

/// [voxels] Least BandCertificate::within. The proxy rests on the surface to far less than that. A
/// search from farther off goes by the bound on the distance that is known outside the band. A band
/// of 6 voxels about a smooth surface that is oblique to all axes has 0.8, and proportionally less
/// where slopes are steeper.
inline constexpr double kLeastWithin = 0.1;
/// Most of BandCertificate::steepest. Voxels that differ by no more than the way between them give
/// a cubic spline whose bound along one axis is at most 9 (3 for the differences of its
/// coefficients, times the square root of 3 for each of the two other axes), and less than 16 along
/// any direction. What is steeper is not made of distances. Edges of a box come to 1.8, holes of a
/// voxel in a scan to 4.
inline constexpr double kMostSteep = 16.0;
/// Most of BandCertificate::rough without a roughNote(). Of a ball as small as a voxel all cells
/// are rough, of one twice as large none; edges take 3 % of a cube 40 voxels wide, thin bones at
/// 128 voxels along a foot a third.
inline constexpr double kMostRough = 0.5;

/// 16 hexadecimal digits of all that a sample can depend on: voxels, band, place and unit. Names
/// and other metadata do not count. Not a signature: it tells damage, not forgery.
[[nodiscard]] PALPATE_EXPORT std::string contentHash(const LevelSet& grid);

/// The certificate in the metadata (`palpate:certificate`), if it is of `sampler` and of this very
/// content.
[[nodiscard]] PALPATE_EXPORT std::optional<BandCertificate> storedCertificate(
    const LevelSet& grid, Sampler sampler = Sampler::kCubic);

/// The same grid, with the certificate in its metadata.
[[nodiscard]] PALPATE_EXPORT LevelSet withCertificate(const LevelSet& grid,
                                                      const BandCertificate& certificate);

/// The settings of certified().
struct CertifyOptions {
  Sampler sampler = Sampler::kCubic;  ///< the sampler that will read the grid
  /// The grid was made by others, or its file may have been damaged: its voxels are held against
  /// each other, too.
  bool is_foreign = true;
  std::string path = {};  ///< of the file, for errors
  /// Where grids are kept that took long to widen or rebuild; empty: nowhere. See GridCache.
  std::string cache_folder = {};
  std::uint64_t max_memory = 0;  ///< [bytes] of the grid and what is made of it; 0: no limit
};

/// A grid that may be felt.
struct CertifiedGrid {
  LevelSet grid;  ///< wide enough for the sampler; distances rebuilt if those that it came with
                  ///< were wrong
  BandCertificate certificate;     ///< that of `grid`
  std::vector<std::string> notes;  ///< what was done to it; empty: nothing
};

/// Makes sure of a grid, or says why not. A certificate in its metadata is taken if it is of this
/// content. Otherwise all its voxels and cells are looked at once. A band too narrow is widened.
/// Distances that contradict each other, or are missing, away from the surface are rebuilt from the
/// surface and told; beside the surface nothing tells where it is, and the grid is refused.
/// @throws Error: kInput naming place and remedy (vdb.gradient: values are not distances in the
/// grid's unit; vdb.no_inside; vdb.no_surface: samples are outside everywhere; vdb.torn: the band
/// has a hole or inside and outside meet; vdb.jump: voxels by the surface differ by more than their
/// distance; vdb.uncertified: points near the surface would not answer, or samples by the surface
/// are steeper than kMostSteep), kOperation for memory, kCancelled.
[[nodiscard]] PALPATE_EXPORT CertifiedGrid certified(const LevelSet& grid,
                                                     const CertifyOptions& options = {},
                                                     const Progress& progress = {});

/// What users should know of a surface more of which than kMostRough is rough: BandCertificate::off
/// does not hold there. Empty: nothing.
[[nodiscard]] PALPATE_EXPORT std::string roughNote(const LevelSet& grid,
                                                   const BandCertificate& certificate);

}  // namespace palpate::vdb
