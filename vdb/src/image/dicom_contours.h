#pragma once
/// Structure sets of radiotherapy: contours on slices, filled to masks.

#include <string>

#include "image/dicom_elements.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::vdb {

/// True for the storage class of structure sets.
[[nodiscard]] bool isDicomStructureSet(const DicomElements& file);

/// Structures from 1, in the file's order. Their voxels are those of the series that the file
/// refers to, if that is in its folder; else of a grid of its own, in the contours' planes. A voxel
/// is of a structure if its center is inside an odd number of its closed contours on that slice, so
/// that a contour in another is a hole. Overlaps go as mergeStructures() says.
/// @throws Error (kInput, codes "dicom.*").
[[nodiscard]] Image readDicomStructureSet(const std::string& path, const ImageOptions& options);
[[nodiscard]] ImageInfo readDicomStructureSetInfo(const std::string& path);
[[nodiscard]] LabelCodes readDicomStructureSetCodes(const std::string& path);

}  // namespace palpate::vdb
