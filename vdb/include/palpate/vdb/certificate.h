#pragma once
/// Checks the properties of a grid that contact relies on, once and for every point between its
/// voxels.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/core/progress.h"
#include "palpate/export.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Holds for a grid as one Sampler reads it (kAccessor: as kTrilinear). Bounds come from the
/// spline's coefficients, not from samples.
struct BandCertificate {
  Sampler sampler = Sampler::kCubic;  ///< the sampler that the numbers hold for
  double within =
      0.0;  ///< [m] every point this near to the surface answers with value and gradient
  double lipschitz = 1.0;  ///< [-] Lipschitz bound of the samples, everywhere; about 4 where
                           ///< distances to all sides meet
  double steepest = 1.0;   ///< [-] where |value| is below 1.5 voxels, no slope is steeper than this
  /// [-] In each cell that may hold the surface the value grows at least this fast along some
  /// direction. Not above 0: there is an edge, a cusp or a part as thin as the cell.
  double slope = 1.0;
  Vec3 slope_place{0.0};  ///< [m] where `slope` is smallest
  double rough = 0.0;     ///< [-] share of these cells in which the slope may be below 0.4
  /// [m] How far the surface that is felt is off the intended one, where that is smooth over some
  /// four voxels: the sampler's error, plus, if others made the grid, how far a voxel can be off
  /// without contradicting its neighbors.
  double off = 0.0;
  std::string content;  ///< contentHash() of the grid that it belongs to
};

/// [voxels] Least BandCertificate::within. The proxy rests on the surface far more closely than
/// that; a search from farther off uses the bound on the distance that is known outside the band. A
/// band of 6 voxels about a smooth surface that is oblique to all axes reaches 0.8, and
/// proportionally less where slopes are steeper.
inline constexpr double kLeastWithin = 0.1;
/// Largest BandCertificate::steepest that is accepted. If voxels differ by no more than the
/// distance between them, a cubic spline through them has a slope of at most 9 along one axis (3
/// for the differences of its coefficients, times the square root of 3 for each of the two other
/// axes), and less than 16 along any direction. Anything steeper is not made of distances. Edges of
/// a box come to 1.8, holes of one voxel in a scan to 4.
inline constexpr double kMostSteep = 16.0;
/// Largest BandCertificate::rough without a roughNote(). In a ball as small as a voxel all cells
/// are rough, in one twice as large none; edges take 3 % of a cube 40 voxels wide, thin bones a
/// third in a foot that is 128 voxels long.
inline constexpr double kMostRough = 0.5;

/// 16 hexadecimal digits that depend on all that a sample can depend on: voxels, band, place and
/// unit. Names and other metadata do not count. Not a signature: it shows damage, not forgery.
[[nodiscard]] PALPATE_EXPORT std::string contentHash(const LevelSet& grid);

/// The certificate in the metadata (`palpate:certificate`), if it is for `sampler` and for this
/// very content.
[[nodiscard]] PALPATE_EXPORT std::optional<BandCertificate> storedCertificate(
    const LevelSet& grid, Sampler sampler = Sampler::kCubic);

/// The same grid, with the certificate in its metadata.
[[nodiscard]] PALPATE_EXPORT LevelSet withCertificate(const LevelSet& grid,
                                                      const BandCertificate& certificate);

/// The settings of certified().
struct CertifyOptions {
  Sampler sampler = Sampler::kCubic;  ///< the sampler that will read the grid
  /// Whether others made the grid, or its file may have been damaged: its voxels are then checked
  /// against each other, too.
  bool is_foreign = true;
  std::string path = {};  ///< of the file, for errors
  /// Where grids are kept that took long to widen or rebuild; empty: nowhere. See GridCache.
  std::string cache_folder = {};
  std::uint64_t max_memory = 0;  ///< [bytes] of the grid and everything made from it; 0: no limit
};

/// A grid that may be felt.
struct CertifiedGrid {
  /// Wide enough for the sampler; distances rebuilt if the original ones were wrong.
  LevelSet grid;
  BandCertificate certificate;     ///< that of `grid`
  std::vector<std::string> notes;  ///< what was done to it; empty: nothing
};

/// Certifies a grid, or says why it cannot. A certificate in its metadata is accepted if it belongs
/// to this content. Otherwise all its voxels and cells are looked at once. A band that is too
/// narrow is widened. Distances away from the surface that contradict each other, or are missing,
/// are rebuilt from the surface, with a note; beside the surface nothing else tells where it is, so
/// that the grid is refused.
/// @throws Error: kInput naming place and remedy (vdb.gradient: values are not distances in the
/// grid's unit; vdb.no_inside; vdb.no_surface: samples are outside everywhere; vdb.torn: the band
/// has a hole or inside and outside meet; vdb.jump: voxels by the surface differ by more than their
/// distance; vdb.uncertified: points near the surface would not answer, or samples by the surface
/// are steeper than kMostSteep), kOperation for memory, kCancelled.
[[nodiscard]] PALPATE_EXPORT CertifiedGrid certified(const LevelSet& grid,
                                                     const CertifyOptions& options = {},
                                                     const Progress& progress = {});

/// A note for users about a surface that is rough in more than kMostRough of its cells:
/// BandCertificate::off does not hold there. Empty: there is nothing to say.
[[nodiscard]] PALPATE_EXPORT std::string roughNote(const LevelSet& grid,
                                                   const BandCertificate& certificate);

}  // namespace palpate::vdb
