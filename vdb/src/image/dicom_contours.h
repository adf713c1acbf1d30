#pragma once
/// Structure sets of radiotherapy: contours on slices, filled to masks.

#include <string>

#include "image/dicom_elements.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::vdb {

/// True for the storage class of structure sets.
[[nodiscard]] bool isDicomStructureSet(const DicomElements& file);

/// Structures are numbered from 1, in the file's order. The voxels are those of the series that the
/// file refers to, if that is in its folder; otherwise those of a new grid in the contours' planes.
/// A voxel belongs to a structure if its center is inside an odd number of the structure's closed
/// contours on that slice, so that a contour within another one is a hole. Overlaps are resolved by
/// mergeStructures().
/// @throws Error (kInput, codes "dicom.*").
[[nodiscard]] Image readDicomStructureSet(const std::string& path, const ImageOptions& options);
[[nodiscard]] ImageInfo readDicomStructureSetInfo(const std::string& path);
[[nodiscard]] LabelCodes readDicomStructureSetCodes(const std::string& path);

}  // namespace palpate::vdb
