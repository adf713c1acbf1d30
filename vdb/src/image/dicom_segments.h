#pragma once
/// DICOM segmentations: binary, fractional and label maps.

#include <string>

#include "image/dicom_elements.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::vdb {

/// True for the storage classes of voxel segmentations.
[[nodiscard]] bool isDicomSegmentation(const DicomElements& file);

/// Segments keep their numbers. A voxel belongs to a fractional segment if its value is at least
/// half of the largest possible one. Planes without a frame are empty; one more empty plane is
/// added at each end. Overlaps are resolved by mergeStructures().
/// @throws Error (kInput, codes "dicom.*").
[[nodiscard]] Image readDicomSegmentation(const std::string& path, const ImageOptions& options);
[[nodiscard]] ImageInfo readDicomSegmentationInfo(const std::string& path);
[[nodiscard]] LabelCodes readDicomSegmentationCodes(const std::string& path);

}  // namespace palpate::vdb
