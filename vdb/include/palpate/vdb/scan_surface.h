#pragma once
/// Surfaces out of scans: thresholds and labels -> level sets.

#include <optional>
#include <string>
#include <vector>

#include "palpate/vdb/bake.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

struct ThresholdOptions {
  double above = 0.0;             ///< inside is where the image is greater
  bool largest_component = true;  ///< keep only the largest (6-connected) piece
  bool fill = false;              ///< close enclosed cavities
  double voxel_size = 0.0;        ///< [m] 0: the image's smallest spacing
};

/// @throws Error (kInput) if nothing lies above the threshold.
[[nodiscard]] LevelSet surfaceFromThreshold(const Image& image, const ThresholdOptions& options,
                                            const BakeOptions& bake, const Progress& progress = {});

struct LabelOptions {
  std::vector<int> values;  ///< the union of these labels
  double voxel_size = 0.0;  ///< [m] 0: the image's smallest spacing
};

/// @throws Error (kInput) if no voxel has one of the labels.
[[nodiscard]] LevelSet surfaceFromLabels(const Image& image, const LabelOptions& options,
                                         const BakeOptions& bake, const Progress& progress = {});

/// `match` entries (a value, a name, or a glob over names) -> label values. @throws Error (kInput) with a
/// suggestion for an entry that matches nothing.
[[nodiscard]] std::vector<int> resolveLabels(const std::vector<std::string>& match,
                                             const NameTable& names, const std::string& source);

}  // namespace palpate::vdb
