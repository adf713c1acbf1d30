#pragma once
/// What is to be said of a scene's walls before they are felt: sharp contrasts of stiffness, and
/// shading that looks further than a grid knows.

#include <string>
#include <vector>

#include "palpate/scene/scene.h"
#include "report.h"

namespace palpate::tools {

struct WallNote {
  std::string code;  ///< "scene.contrast" or "scene.shading_band"
  std::string text;
  Vec3 place{0.0, 0.0, 0.0};  ///< [m]
  bool is_warning = false;    ///< worth to be said before every run; else in `explain` only
  Json json;
};

/// Of a compiled scene, as the `constraint` renderer feels it. Lengths in texts are in the scene's
/// unit.
[[nodiscard]] std::vector<WallNote> wallNotes(const Scene& scene);

}  // namespace palpate::tools
