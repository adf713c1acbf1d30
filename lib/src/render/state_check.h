#pragma once
/// Whether a state from elsewhere is one that a renderer can go on from.

#include "palpate/render/tick_state.h"
#include "palpate/scene/scene.h"

namespace palpate {

/// Whether every number in `state` that stands for a part of a scene is valid in `scene`, and every
/// other one is finite: then update() is safe with it. A state that has begun must be of a renderer
/// of `kind`. Real-time safe.
[[nodiscard]] bool isStateOf(const TickState& state, RendererKind kind,
                             const Scene& scene) noexcept;

}  // namespace palpate
