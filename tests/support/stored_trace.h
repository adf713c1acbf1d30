#pragma once
// Stores what a scene feels like as a small text beside the tests, so that a change of numbers
// between versions is noticed. PALPATE_REWRITE_TRACES=1 writes the texts anew.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "palpate/render/haptic_renderer.h"

namespace palpate::test {

/// The path [m] of a scene, 1200 ticks: from place to place in and around its bounds, smoothly, and
/// from time to time back out.
[[nodiscard]] std::vector<Vec3> pathThrough(const Scene& scene);

/// Drives a renderer of `kind` along the path that follows from `scene`'s bounds, and compares its
/// results with `file`; or writes `file`. A scene that the renderer refuses is stored as one line
/// with the error's code.
///
/// Proxies must agree within 1e-8 m, forces within 1e-5 N plus 1e-5 of their size. That is a
/// hundred times the effect of two compilers' rounding on minima that are met to 1e-6 of a depth of
/// some millimeters, and a thousandth of what a hand can feel. Regions, contact and the ports
/// passed must agree exactly.
[[nodiscard]] ::testing::AssertionResult compareWithStored(const ScenePtr& scene, RendererKind kind,
                                                           const std::string& file);

}  // namespace palpate::test
