#pragma once
/// A way for a first touch of an imported scene.

#include "import/imported_scene.h"

namespace palpate::tools {

/// From one of six sides to the middle of what is labeled, or to 1 mm beyond the first surface that
/// stays closed, of what is rigid or of the image: a hand that is led farther presses on it with
/// hundreds of newtons. The side from which the way is longest.
[[nodiscard]] SuggestedWay suggestedWay(const ImportedScan& scan);

}  // namespace palpate::tools
