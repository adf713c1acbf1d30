#pragma once
/// Unpacks packed DICOM pixels with GDCM. The only file that includes GDCM.

#include <string>
#include <vector>

#include "image/dicom_elements.h"

namespace palpate::vdb {

/// The pixels packed in `fragments` (a table of offsets first, as in the file), low byte first.
/// GDCM gets a file written here from checked numbers; of the original file it sees only the
/// fragments.
/// @throws Error (kInput, dicom.pixels).
[[nodiscard]] std::string unpackDicom(const DicomElements& slice,
                                      const std::vector<std::string>& fragments);

}  // namespace palpate::vdb
