#pragma once
/// Which voxels of a scene's label images have their centers in another layer than that of their
/// label.

#include <string>
#include <vector>

#include "loaded_scene.h"
#include "palpate/vdb/label_centers.h"
#include "report.h"

namespace palpate::tools {

struct ImageCenters {
  std::string image;                ///< its name in the scene
  bool has_voxels = true;           ///< false: a bundle without its scan
  std::vector<std::string> layers;  ///< parts of `centers` by their index
  vdb::LabelCenters centers;
};

/// The centers of each image whose labels layers use, in the order of the file. Centers in a layer
/// that uses none of the image's labels do not count.
[[nodiscard]] std::vector<ImageCenters> imageCenters(const LoadedScene& loaded, const Scene& scene);

[[nodiscard]] Json centersJson(const std::vector<ImageCenters>& all);
/// A line for each image, and one for each layer of it that has such a voxel.
[[nodiscard]] std::string centersText(const std::vector<ImageCenters>& all, const LengthUnit& unit);

}  // namespace palpate::tools
