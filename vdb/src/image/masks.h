#pragma once
/// Masks, a structure each, that lie on one grid: the files of a folder, or files that are listed.

#include <string>
#include <vector>

#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::vdb {

/// True if the folder holds NIfTI, NRRD or MetaImage files.
[[nodiscard]] bool isMaskFolder(const std::string& path);

/// The masks of a folder, by name; or `path` and then `with`, in their order.
[[nodiscard]] std::vector<std::string> maskFiles(const std::string& path,
                                                 const std::vector<std::string>& with);

/// A label image whose labels are the masks, from 1 in their order, called as their files are. A
/// voxel is of a mask where that is not 0. Overlaps go as mergeStructures() says.
/// @throws Error (kInput): masks.grid for one that lies elsewhere, masks.values for one of several
/// values, masks.name for two of one name; also what the files' own readers throw.
[[nodiscard]] Image readMasks(const std::string& path, const ImageOptions& options);
[[nodiscard]] ImageInfo readMasksInfo(const std::string& path, const ImageOptions& options);
/// Of those masks that have a code of their own.
[[nodiscard]] LabelCodes readMaskCodes(const std::string& path, const ImageOptions& options);

}  // namespace palpate::vdb
