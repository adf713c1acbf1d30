#pragma once
/// The pixels of a DICOM slice.

#include <cstdint>
#include <vector>

#include "image/dicom_elements.h"

namespace palpate::vdb {

/// Pixel values of each slice as stored, without slope and intercept, in order. Rows, columns and
/// bits of the elements must have been checked, and be the same for all. Plain pixels are read by
/// our own code; packed ones are unpacked by GDCM, in a child process if libraryLimits() say so.
/// @throws Error (kInput, dicom.pixels): not unpacked, or not those that the elements describe;
/// dicom.truncated.
[[nodiscard]] std::vector<std::vector<std::int32_t>> readDicomPixels(
    const std::vector<DicomElements>& slices);

}  // namespace palpate::vdb
