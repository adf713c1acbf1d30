#pragma once
/// Models, a mesh for each structure, as the label image that an import begins with: as 3D Slicer
/// exports a segmentation, and as atlases come.

#include <string>
#include <vector>

#include "console.h"
#include "options.h"
#include "palpate/vdb/image.h"

namespace palpate::tools {

/// Whether `scans` are meshes, or a folder that holds some and no images.
[[nodiscard]] bool areModels(const std::vector<std::string>& scans);

/// Voxels are those of --voxel, else 1/256 of the models' longest side. Names are those of the
/// files, or of the table that `options.names` names, if it has the number that stands in a file's
/// name ("Model_12_liver.vtk").
/// @throws Error (kInput): models.*; what the meshes' reader throws; kUsage for options of images.
[[nodiscard]] vdb::Image readModels(const ImportOptions& options, Console& console);

}  // namespace palpate::tools
