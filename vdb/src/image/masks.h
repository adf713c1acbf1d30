#pragma once
/// Masks on one grid, one for each structure: the files of a folder, or listed files.

#include <string>
#include <vector>

#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::vdb {

/// True if the folder holds NIfTI, NRRD or MetaImage files.
[[nodiscard]] bool isMaskFolder(const std::string& path);

/// The masks of a folder, sorted by name; or `path` followed by `with`, in their order.
[[nodiscard]] std::vector<std::string> maskFiles(const std::string& path,
                                                 const std::vector<std::string>& with);

/// A label image whose labels are the masks, numbered from 1 in their order and named as their
/// files are. A voxel belongs to a mask where the mask is not 0. Overlaps are resolved by
/// mergeStructures().
/// @throws Error (kInput): masks.grid for a mask with other voxels, masks.values for one with
/// several values, masks.name for two with one name; also everything that the files' own readers
/// throw.
[[nodiscard]] Image readMasks(const std::string& path, const ImageOptions& options);
[[nodiscard]] ImageInfo readMasksInfo(const std::string& path, const ImageOptions& options);
/// The codes of those masks whose files have one.
[[nodiscard]] LabelCodes readMaskCodes(const std::string& path, const ImageOptions& options);

}  // namespace palpate::vdb
