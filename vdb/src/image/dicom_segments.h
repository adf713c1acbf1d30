#pragma once
/// DICOM segmentations: binary, fractional and label maps.

#include <string>

#include "image/dicom_elements.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::vdb {

/// True for the storage classes of segmentations of voxels.
[[nodiscard]] bool isDicomSegmentation(const DicomElements& file);

/// Segments by their numbers. A voxel is of a fractional segment from half of the largest value on.
/// Planes without a frame are empty, and so is one more at each end. Overlaps go as
/// mergeStructures() says.
/// @throws Error (kInput, codes "dicom.*").
[[nodiscard]] Image readDicomSegmentation(const std::string& path, const ImageOptions& options);
[[nodiscard]] ImageInfo readDicomSegmentationInfo(const std::string& path);
[[nodiscard]] LabelCodes readDicomSegmentationCodes(const std::string& path);

}  // namespace palpate::vdb
