#pragma once
/// Codes of labels, as segmentations carry them beside names.

#include <map>
#include <string>

#include "palpate/export.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// The meaning of a label in a coding scheme: SCT (SNOMED CT), 272673000, Bone.
struct LabelCode {
  std::string scheme;   ///< system of codes: "SCT"
  std::string value;    ///< the code: "272673000"
  std::string meaning;  ///< in words: "Bone"
};
using LabelCodes = std::map<int, LabelCode>;  ///< by label value

/// The type of each segment of a .seg.nrrd file, a DICOM segmentation or structure set, by the
/// label values of readImage(), where the file states one; empty for other files. @throws Error
/// (kInput) as readImage().
[[nodiscard]] PALPATE_EXPORT LabelCodes readLabelCodes(const std::string& path,
                                                       const ImageOptions& options = {});

}  // namespace palpate::vdb
