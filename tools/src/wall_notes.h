#pragma once
/// Notes on a scene's walls before they are felt: sharp contrasts of stiffness, and shading that
/// needs a wider band than a grid has.

#include <string>
#include <vector>

#include "palpate/scene/scene.h"
#include "report.h"

namespace palpate::tools {

struct WallNote {
  std::string code;  ///< "scene.contrast" or "scene.shading_band"
  std::string text;
  Vec3 place{0.0, 0.0, 0.0};  ///< [m]
  bool is_warning = false;    ///< worth printing before every run; others appear in `explain` only
  Json json;
};

/// Notes on a compiled scene, as the `constraint` renderer feels it. Lengths in texts are in the
/// scene's unit.
[[nodiscard]] std::vector<WallNote> wallNotes(const Scene& scene);

}  // namespace palpate::tools
