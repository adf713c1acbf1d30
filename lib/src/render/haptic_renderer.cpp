#include "palpate/render/haptic_renderer.h"

#include "constraint_renderer.h"
#include "palpate/core/error.h"
#include "paper_renderer.h"

namespace palpate {

std::unique_ptr<HapticRenderer> makeRenderer(ScenePtr scene, RendererSettings settings) {
  if (!scene) throw inputError("render.no_scene", "makeRenderer() was given no scene");
  if (settings.kind.value_or(scene->renderer()) == RendererKind::kPaper) {
    return std::make_unique<PaperRenderer>(std::move(scene), settings);
  }
  return std::make_unique<ConstraintRenderer>(std::move(scene));
}

}  // namespace palpate
