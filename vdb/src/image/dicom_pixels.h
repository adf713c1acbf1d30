#pragma once
/// Pixels of one DICOM file, by GDCM.

#include <cstdint>
#include <vector>

#include "image/dicom_elements.h"

namespace palpate::vdb {

/// Rows * columns whole numbers as stored, before slope and intercept. `elements` are those of the file, so it
/// is whole. @throws Error (kInput, dicom.pixels): what is compressed cannot be unpacked.
[[nodiscard]] std::vector<std::int32_t> readDicomPixels(const DicomElements& elements);

}  // namespace palpate::vdb
