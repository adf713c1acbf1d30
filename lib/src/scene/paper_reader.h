#pragma once
/// `paper` of a scene: the parameters of the paper's renderer.

#include "palpate/scene/description.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

[[nodiscard]] PaperParameters readPaper(const MapReader& reader);

}  // namespace palpate
