#pragma once
// Whether what a renderer leaves for the next tick is all there is to it: saved and given back, the
// same comes again.

#include <gtest/gtest.h>

#include "palpate/render/haptic_renderer.h"

namespace palpate::test {

/// True if PALPATE_SLOW_TESTS asks for all of it.
[[nodiscard]] bool runsSlowTests();

/// At `states` random ticks of the scene's path: saves the state by checkpoint(), goes 500 ticks
/// on, gives it back and goes the same 500 again; and once more in a renderer that was elsewhere
/// before. All bit for bit. A scene that the renderer refuses passes: that it does is kept with the
/// stored traces.
[[nodiscard]] ::testing::AssertionResult goesOnFromItsStates(const ScenePtr& scene,
                                                             RendererKind kind, int states);

/// Two renderers of one scene, fed in turns along the scene's path and back along it, feel what
/// each does alone, bit for bit.
[[nodiscard]] ::testing::AssertionResult areApart(const ScenePtr& scene, RendererKind kind);

}  // namespace palpate::test
