#pragma once
/// Names of labels in a NIfTI file's extensions.

#include <span>
#include <string>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// `extensions` is what stands between a NIfTI header and its voxels, beginning with the four bytes
/// that say whether there is any; `swapped`: in the other byte order. The table of the first
/// extension (of comments or of Caret) that has a <LabelTable>; empty if none does.
/// @throws Error (kInput, "nifti.labels"): the table cannot be read.
[[nodiscard]] LabelTable niftiLabels(std::span<const unsigned char> extensions, bool swapped,
                                     const std::string& path);

}  // namespace palpate::vdb
