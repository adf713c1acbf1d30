#pragma once
/// Coded concepts and colors, as DICOM writes them.

#include <optional>
#include <vector>

#include "image/dicom_elements.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::vdb {

/// The first code of a sequence of them; nothing if there is none.
[[nodiscard]] std::optional<LabelCode> codeIn(const DicomItem& holder, std::uint32_t sequence);

/// Converts CIE L*, a*, b* in 16 bits each (white D65) to sRGB; colors outside sRGB are clamped.
[[nodiscard]] LabelColor colorOfLab(const std::vector<int>& lab);

}  // namespace palpate::vdb
