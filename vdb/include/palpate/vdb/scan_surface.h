#pragma once
/// Surfaces from scans: thresholds and labels -> level sets.
///
/// Voxels are chosen first, by the rules below. Then a smooth function that separates the chosen
/// voxels from the others is found in index space and carried to the world by the image's affine
/// (oblique, sheared and left-handed ones too), and the distance to its zero set is baked to cubic
/// voxels: the closest point on a C2 spline. A shape that is cut off by the image's border ends
/// there in flat walls, half a voxel beyond the outermost voxel centers. Enclosed cavities are
/// outside, unless they are filled.
///
/// Set-up only, on any thread; several threads may use one image. Metadata written besides
/// `bake.metadata`: "source" (the image's file), "frame" ("RAS"), and "threshold" or "labels".

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
  /// Keep only the largest connected component; voxels are connected by faces
  bool largest_component = true;
  /// Fill cavities: all voxels that no path of outside voxels (across faces and edges) joins to the
  /// border of the image. Spaces that an air path leads into, like nose and windpipe, stay open.
  bool fill = false;
  double voxel_size = 0.0;  ///< [m] 0: bake.voxel_size; 0 as well: the image's smallest spacing
};

/// The wall is the iso-surface of the image, interpolated by a C2 tri-cubic spline, at `above` (or
/// `below`), with an error of a small share of a voxel where the image is smooth.
/// @throws Error (kInput) if the threshold is not finite, or nothing lies above (below) it.
[[nodiscard]] PALPATE_EXPORT LevelSet surfaceFromThreshold(const Image& image,
                                                           const ThresholdOptions& options,
                                                           const BakeOptions& bake,
                                                           const Progress& progress = {});

/// The settings of surfaceFromLabels().
struct LabelOptions {
  std::vector<int> values;  ///< the union of these labels
  double voxel_size = 0.0;  ///< [m] 0: bake.voxel_size; 0 as well: the image's smallest spacing
};

/// The surface bends as little, and as evenly, as the voxels allow: voxel centers stay on their
/// side of it (or on it). A voxelized ball, torus or tilted plane gets normals within half a degree
/// (RMS) and a mean offset within 0.03 voxel, in cubic voxels; with slices several times thicker
/// than their voxels are wide, normals are off by degrees. The surface encloses the volume of the
/// voxels. Parts one or two voxels thin are held open. LabelSurfaces makes the walls of several
/// labels fit.
/// @throws Error (kInput) if no voxel has one of the labels.
[[nodiscard]] PALPATE_EXPORT LevelSet surfaceFromLabels(const Image& image,
                                                        const LabelOptions& options,
                                                        const BakeOptions& bake,
                                                        const Progress& progress = {});

/// How the surface of a layer ends where another begins.
enum class LabelEdge : std::uint8_t {
  /// At one wall for both: each encloses its own voxels. Each grid has its own distances to that
  /// wall, which agree within a hundredth of a voxel (a tenth or two in stretched voxels). Where
  /// three or more layers meet (space in no layer counts as one) their walls meet in an edge, which
  /// grids round off: to queries that take a negative field for inside, gaps of up to half a voxel
  /// are left.
  kShared,
  /// A fifth of a voxel of the image (in stretched ones up to half their smallest spacing) beyond
  /// that wall, within the neighbor, so that nothing is left between them; the layer with the
  /// smaller field gets a point, as in the layers of a scene (LayerDescription::label_group).
  kLapped,
};

/// Surfaces of several layers of one label image, with one wall between neighbors. Every point is
/// in exactly one of the layers or in the surroundings: in the one whose field is smallest, where
/// the field of the surroundings is -united(). Layers that have a label in common do not limit each
/// other.
class PALPATE_EXPORT LabelSurfaces {
 public:
  /// `image` must outlive it. `layers`: the labels of each.
  LabelSurfaces(const Image& image, std::vector<std::vector<int>> layers);
  ~LabelSurfaces();
  LabelSurfaces(const LabelSurfaces&) = delete;
  LabelSurfaces& operator=(const LabelSurfaces&) = delete;

  /// As surfaceFromLabels(). The smoothed function of one layer is kept for its neighbors. With
  /// lapped layers, voxels of neighbors do not count as filled.
  [[nodiscard]] LevelSet surface(std::size_t layer, double voxel_size, const BakeOptions& bake,
                                 const Progress& progress = {},
                                 LabelEdge edge = LabelEdge::kShared);

  /// All layers together; nothing if no voxels of two layers lie beside each other: then there is
  /// no wall between them that could be lost.
  [[nodiscard]] std::optional<LevelSet> united(double voxel_size, const BakeOptions& bake,
                                               const Progress& progress = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Voxels of a scan whose centers are on the wrong side of a surface by more than a fifth of the
/// grid's voxel; or by any amount, where a single voxel is the wall and the grid has a hole through
/// it. There a part, or a gap, is too thin for the grid. No loss is silent: each surface above
/// carries this in its metadata ("lost_voxels", "filled_voxels", "lost_at" in [m]; absent where
/// nothing is lost).
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
/// each once. A value need not have a name. A glob leaves out label 0, the background. `source` is
/// the table's file, for messages. @throws Error (kInput) with a suggestion for an entry that
/// matches nothing.
[[nodiscard]] PALPATE_EXPORT std::vector<int> resolveLabels(const std::vector<std::string>& match,
                                                            const NameTable& names,
                                                            const std::string& source);

}  // namespace palpate::vdb
