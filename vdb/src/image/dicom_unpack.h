#pragma once
/// Packed pixels of DICOM, unpacked by GDCM. The one place that sees GDCM.

#include <string>
#include <vector>

#include "image/dicom_elements.h"

namespace palpate::vdb {

/// The pixels that `fragments` (a table of offsets first, as in the file) pack, low byte first.
/// GDCM gets a file that is made here out of numbers that were checked; of the stranger's it sees
/// the fragments only.
/// @throws Error (kInput, dicom.pixels).
[[nodiscard]] std::string unpackDicom(const DicomElements& slice,
                                      const std::vector<std::string>& fragments);

}  // namespace palpate::vdb
