#pragma once
// Checks that a renderer's saved state is complete: after it is restored, the same ticks give the
// same results.

#include <gtest/gtest.h>

#include "palpate/render/haptic_renderer.h"

namespace palpate::test {

/// True if PALPATE_SLOW_TESTS asks for all of them.
[[nodiscard]] bool runsSlowTests();

/// At `states` random ticks of the scene's path: saves the state by checkpoint(), runs 500 more
/// ticks, restores the state and runs the same 500 again; and once more in a renderer that was
/// elsewhere before. Everything must agree bit for bit. A scene that the renderer refuses passes;
/// the stored traces record that refusal.
[[nodiscard]] ::testing::AssertionResult goesOnFromItsStates(const ScenePtr& scene,
                                                             RendererKind kind, int states);

/// Two renderers of one scene, fed alternately along the scene's path and its reverse, feel what
/// each feels alone, bit for bit.
[[nodiscard]] ::testing::AssertionResult areApart(const ScenePtr& scene, RendererKind kind);

}  // namespace palpate::test
