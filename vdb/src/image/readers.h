#pragma once
/// One reader for each format, and one for its header alone.

#include <string>

#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::vdb {

/// NRRD, .nrrd, .nhdr and .seg.nrrd. @throws Error (kInput, codes "nrrd.*").
[[nodiscard]] Image readNrrd(const std::string& path, const ImageOptions& options);
[[nodiscard]] ImageInfo readNrrdInfo(const std::string& path, const ImageOptions& options);
[[nodiscard]] LabelCodes readNrrdCodes(const std::string& path, const ImageOptions& options);

/// MetaImage, .mha and .mhd. @throws Error (kInput, codes "metaimage.*").
[[nodiscard]] Image readMetaImage(const std::string& path, const ImageOptions& options);
[[nodiscard]] ImageInfo readMetaImageInfo(const std::string& path, const ImageOptions& options);

/// A DICOM series: a folder, or one file of it; or a segmentation or structure set.
/// @throws Error (kInput, codes "dicom.*").
[[nodiscard]] Image readDicom(const std::string& path, const ImageOptions& options);
[[nodiscard]] ImageInfo readDicomInfo(const std::string& path, const ImageOptions& options);
[[nodiscard]] LabelCodes readDicomCodes(const std::string& path, const ImageOptions& options);

/// True if the file begins the way DICOM files do.
[[nodiscard]] bool isDicomFile(const std::string& path);
/// True if a file directly in the folder is a DICOM file.
[[nodiscard]] bool isDicomFolder(const std::string& path);

}  // namespace palpate::vdb
