#pragma once
/// Names of labels in a NIfTI file's extensions.

#include <span>
#include <string>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// `extensions` are the bytes between a NIfTI header and its voxels, beginning with the four bytes
/// that say whether there are extensions; `swapped`: in the other byte order. Returns the table of
/// the first extension (a comment or one of Caret's) that has a <LabelTable>; empty if none does.
/// @throws Error (kInput, "nifti.labels") if the table cannot be read.
[[nodiscard]] LabelTable niftiLabels(std::span<const unsigned char> extensions, bool swapped,
                                     const std::string& path);

}  // namespace palpate::vdb
