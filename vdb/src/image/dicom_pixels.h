#pragma once
/// The pixels of a DICOM slice.

#include <cstdint>
#include <vector>

#include "image/dicom_elements.h"

namespace palpate::vdb {

/// Stored pixel values of each slice, without slope and intercept, in order. The caller must have
/// checked rows, columns and bits of the elements, and that they are the same for all slices. Plain
/// pixels are read by our own code; packed ones are unpacked by GDCM, in a child process if
/// libraryLimits() say so.
/// @throws Error (kInput, dicom.pixels) if pixels cannot be unpacked, or are not those that the
/// elements describe; dicom.truncated.
[[nodiscard]] std::vector<std::vector<std::int32_t>> readDicomPixels(
    const std::vector<DicomElements>& slices);

}  // namespace palpate::vdb
