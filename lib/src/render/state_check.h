#pragma once
/// Whether a state that comes from elsewhere is one that a renderer can go on from.

#include "palpate/render/tick_state.h"
#include "palpate/scene/scene.h"

namespace palpate {

/// Whether every number in `state` that stands for a part of a scene stands for one of `scene`, and
/// every other is finite: then update() is safe with it. One that has begun must be of a renderer
/// of `kind`. Real-time safe.
[[nodiscard]] bool isStateOf(const TickState& state, RendererKind kind,
                             const Scene& scene) noexcept;

}  // namespace palpate
