#pragma once
/// Surfaces out of scans: thresholds and labels -> level sets.
///
/// Voxels are chosen first, by the rules below; then a smooth function between those chosen and the
/// others is found in index space, carried to the world by the image's affine (oblique, sheared and
/// left-handed ones too), and the distance to its zero set baked to cubic voxels: the closest point
/// on a C2 spline. A shape that is cut off by the image's border ends there in flat walls, half a
/// voxel beyond the outermost voxel centers. Enclosed cavities are outside, unless they are filled.
///
/// Set-up only, on any thread; several may use one image. Metadata written besides `bake.metadata`:
/// "source" (the image's file), "frame" ("RAS"), and "threshold" or "labels".

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palpate/export.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// The settings of surfaceFromThreshold().
struct ThresholdOptions {
  double above = 0.0;                ///< inside is where the image is greater; NaN is outside
  std::optional<double> below = {};  ///< instead of `above`: inside is where the image is less
  bool largest_component = true;     ///< keep only the largest piece; voxels hang together by faces
  /// Fill cavities: all that no path of outside voxels (across faces and edges) joins to the border
  /// of the image. What an air path leads into, like nose and windpipe, stays open.
  bool fill = false;
  double voxel_size = 0.0;  ///< [m] 0: bake.voxel_size; 0 as well: the image's smallest spacing
};

/// The wall is the iso-surface of the image, interpolated by a C2 tri-cubic spline, at `above` (or
/// `below`): where the image is smooth, to a small share of a voxel.
/// @throws Error (kInput) if that is not finite, or nothing lies above (below) it.
[[nodiscard]] PALPATE_EXPORT LevelSet surfaceFromThreshold(const Image& image,
                                                           const ThresholdOptions& options,
                                                           const BakeOptions& bake,
                                                           const Progress& progress = {});

/// The settings of surfaceFromLabels().
struct LabelOptions {
  std::vector<int> values;  ///< the union of these labels
  double voxel_size = 0.0;  ///< [m] 0: bake.voxel_size; 0 as well: the image's smallest spacing
};

/// The surface is one that bends as little, and as evenly, as the voxels allow: voxel centers stay
/// on their side of it (or on it). A voxelized ball, torus or tilted plane gets normals within half
/// a degree (RMS) and a mean offset within 0.03 voxel, in cubic voxels; slices several times
/// thicker than their voxels are wide leave degrees. It encloses the volume of the voxels. Parts
/// one or two voxels thin are held open. LabelSurfaces makes the walls of several labels fit.
/// @throws Error (kInput) if no voxel has one of the labels.
[[nodiscard]] PALPATE_EXPORT LevelSet surfaceFromLabels(const Image& image,
                                                        const LabelOptions& options,
                                                        const BakeOptions& bake,
                                                        const Progress& progress = {});

/// How the surface of a layer ends where another begins.
enum class LabelEdge : std::uint8_t {
  /// At one wall for both: each encloses its own voxels. Each grid has its own distances to that
  /// wall, which
  /// fit within a hundredth of a voxel (a tenth or two in stretched voxels). Where three or more
  /// meet (what is
  /// in no layer counts) their walls meet in an edge, which grids round off: if a field below 0 is
  /// asked for, gaps of
  /// up to half a voxel are left.
  kShared,
  /// A fifth of a voxel of the image (in stretched ones up to half their smallest spacing) beyond
  /// that wall, within
  /// the neighbor, so that nothing is left between them; the smaller field tells which of them has
  /// a point, as
  /// the layers of a scene do (LayerDescription::label_group).
  kLapped,
};

/// Surfaces of several layers of one label image, with one wall between neighbors. Every point is
/// in exactly one of the layers or in the surroundings: in that whose field is smallest, that of
/// the surroundings being -united(). Layers that have a label in common do not limit each other.
class PALPATE_EXPORT LabelSurfaces {
 public:
  /// `image` must outlive it. `layers`: the labels of each.
  LabelSurfaces(const Image& image, std::vector<std::vector<int>> layers);
  ~LabelSurfaces();
  LabelSurfaces(const LabelSurfaces&) = delete;
  LabelSurfaces& operator=(const LabelSurfaces&) = delete;

  /// As surfaceFromLabels(). What is smoothed for one layer is kept for its neighbors. Of lapped
  /// layers, voxels of neighbors are not counted as filled.
  [[nodiscard]] LevelSet surface(std::size_t layer, double voxel_size, const BakeOptions& bake,
                                 const Progress& progress = {},
                                 LabelEdge edge = LabelEdge::kShared);

  /// All layers together; nothing if no voxels of two layers lie beside each other: then there is
  /// nothing between them that could be lost.
  [[nodiscard]] std::optional<LevelSet> united(double voxel_size, const BakeOptions& bake,
                                               const Progress& progress = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Voxels of a scan whose centers a surface has on the wrong side by more than a fifth of the
/// grid's voxel, or at all where a single voxel is the wall and the grid has a hole through it:
/// where a part, or a gap, is too thin for the grid. None is silent: each surface above carries
/// this in its metadata
/// ("lost_voxels", "filled_voxels", "lost_at" in [m]; absent where nothing is lost).
struct ScanLoss {
  std::uint64_t lost = 0;     ///< inside voxels that are outside now
  std::uint64_t filled = 0;   ///< outside ones that are inside now
  Vec3 place{0.0, 0.0, 0.0};  ///< [m] of the one that is furthest on the wrong side
};
/// Reads the loss out of a grid's metadata; all zero where nothing is lost.
[[nodiscard]] PALPATE_EXPORT ScanLoss scanLoss(const LevelSetInfo& info);

/// The same as a sentence for people, in mm; empty if nothing is lost.
[[nodiscard]] PALPATE_EXPORT std::string scanLossNote(const LevelSetInfo& info);

/// `match` entries (a value, a name, or a glob over names; case-sensitive) -> label values, sorted,
/// each once. A value needs no name. A glob leaves out label 0, the background. `source` is the
/// table's file, for messages. @throws Error (kInput) with a suggestion for an entry that matches
/// nothing.
[[nodiscard]] PALPATE_EXPORT std::vector<int> resolveLabels(const std::vector<std::string>& match,
                                                            const NameTable& names,
                                                            const std::string& source);

}  // namespace palpate::vdb
