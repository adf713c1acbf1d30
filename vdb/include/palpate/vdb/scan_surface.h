#pragma once
/// Surfaces out of scans: thresholds and labels -> level sets.
///
/// Voxels are chosen first, by the rules below; then a closed surface is put between those chosen
/// and the others, in index space; it is carried to the world by the image's affine (oblique,
/// sheared and left-handed ones too) and baked to cubic voxels. A shape that is cut off by the
/// image's border ends there in flat walls, half a voxel beyond the outermost voxel centres.
/// Enclosed cavities are outside, unless they are filled.
///
/// Set-up only, on any thread; several may use one image. Metadata written besides `bake.metadata`:
/// "source" (the image's file), "frame" ("RAS"), and "threshold" or "labels".

#include <optional>
#include <string>
#include <vector>

#include "palpate/vdb/bake.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

struct ThresholdOptions {
  double above = 0.0;             ///< inside is where the image is greater; NaN is outside
  bool largest_component = true;  ///< keep only the largest piece; voxels hang together by faces
  /// Fill cavities: all that no path of outside voxels (across faces and edges) joins to the border
  /// of the image. What an air path leads into, like nose and windpipe, stays open.
  bool fill = false;
  double voxel_size = 0.0;  ///< [m] 0: bake.voxel_size; 0 as well: the image's smallest spacing
};

/// Between two voxels the wall lies where the intensity, taken as linear, passes `above`.
/// @throws Error (kInput) if nothing lies above the threshold.
[[nodiscard]] LevelSet surfaceFromThreshold(const Image& image, const ThresholdOptions& options,
                                            const BakeOptions& bake, const Progress& progress = {});

struct LabelOptions {
  std::vector<int> values;  ///< the union of these labels
  double voxel_size = 0.0;  ///< [m] 0: bake.voxel_size; 0 as well: the image's smallest spacing
};

/// The steps of the voxels are smoothed (a Gaussian of 1.25 voxels, with its shrinking of round
/// shapes taken back to first order) as far as no voxel centre changes sides by more than a
/// fraction of a voxel; a sheet one voxel thick stays. Two labels that touch get the same wall from
/// either side.
/// @throws Error (kInput) if no voxel has one of the labels.
[[nodiscard]] LevelSet surfaceFromLabels(const Image& image, const LabelOptions& options,
                                         const BakeOptions& bake, const Progress& progress = {});

/// `match` entries (a value, a name, or a glob over names; case-sensitive) -> label values, sorted,
/// each once. A value needs no name. A glob leaves out label 0, the background. `source` is the
/// table's file, for messages. @throws Error (kInput) with a suggestion for an entry that matches
/// nothing.
[[nodiscard]] std::vector<int> resolveLabels(const std::vector<std::string>& match,
                                             const NameTable& names, const std::string& source);

}  // namespace palpate::vdb
