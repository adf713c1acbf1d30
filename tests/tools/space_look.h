#pragma once
// Scenes in space to draw in tests, and comparison of colors.

#include <gtest/gtest.h>

#include <string>

#include "palpate/scene/scene_file.h"
#include "picture/cutaway.h"
#include "picture/palette.h"

namespace palpate::testing {

inline constexpr const char* kShells =
    "palpate: 1\nlength: mm\nlayers:\n"
    "  - {name: outer, inside: {sphere: {center: [0, 0, 0], radius: 30}}}\n"
    "  - {name: inner, inside: {sphere: {center: [0, 0, 0], radius: 12}}}\n";

/// A scene with everything needed to draw it, kept together.
struct Look {
  explicit Look(const std::string& text)
      : scene(compile(parseScene(text, "test"))),
        paint(nullptr, *scene, {}),
        space{*scene, paint, scene->bounds().grownBy(0.002)} {}

  [[nodiscard]] tools::Camera camera(const Vec3& toward, int pixels) const {
    tools::Camera out = tools::cameraFrom(toward);
    out.center = space.box.center();
    out.width = out.height = pixels;
    out.step = glm::length(space.box.size()) / pixels;
    return out;
  }

  ScenePtr scene;
  tools::Paint paint;
  tools::SpaceScene space;
};

inline void expectNear(const tools::Color& a, const tools::Color& b, double within,
                       const std::string& where) {
  EXPECT_NEAR(a.r, b.r, within) << where;
  EXPECT_NEAR(a.g, b.g, within) << where;
  EXPECT_NEAR(a.b, b.b, within) << where;
}

}  // namespace palpate::testing
