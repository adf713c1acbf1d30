#pragma once
/// Suggests a way for the first touch of an imported scene.

#include "import/imported_scene.h"

namespace palpate::tools {

/// From one of six sides to the middle of the labeled space, or to 1 mm beyond the first surface
/// that stays closed (that of rigid tissue, or the image's border): a hand that goes farther would
/// press on it with hundreds of newtons. Chooses the side with the longest way.
[[nodiscard]] SuggestedWay suggestedWay(const ImportedScan& scan);

}  // namespace palpate::tools
