#pragma once
// What a scene feels like, kept as a small text beside the tests, so that a change of numbers
// between versions is seen. PALPATE_REWRITE_TRACES=1 writes the texts anew.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "palpate/render/haptic_renderer.h"

namespace palpate::test {

/// The path [m] of a scene, 1200 ticks: from place to place in and around its bounds, smoothly, and
/// now and then back out.
[[nodiscard]] std::vector<Vec3> pathThrough(const Scene& scene);

/// Drives a renderer of `kind` along the one path that `scene`'s bounds make, and compares what it
/// says with `file`; or writes `file`. A scene that the renderer refuses is kept as one line with
/// the reason's code.
///
/// Proxies agree within 1e-8 m, forces within 1e-5 N and 1e-5 of themselves: a hundred times what
/// two compilers' rounding makes of minima that are met to 1e-6 of a depth of some millimeters, and
/// below what a hand can feel by a thousand times. Regions, contact and the ports passed agree
/// exactly.
[[nodiscard]] ::testing::AssertionResult compareWithStored(const ScenePtr& scene, RendererKind kind,
                                                           const std::string& file);

}  // namespace palpate::test
