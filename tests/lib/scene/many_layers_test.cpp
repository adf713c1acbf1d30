// Layers next to a layer that is a complement, to which every place far away belongs.

#include <gtest/gtest.h>

#include <string>

#include "palpate/scene/scene.h"
#include "palpate/scene/scene_file.h"

namespace palpate::test {
namespace {

/// A room within rock, and balls in it.
std::string room(int balls) {
  std::string text =
      "palpate: 1\nlength: mm\nlayers:\n"
      "  - {name: rock, inside: {complement: {sphere: {center: [0, 0, 0], radius: 80}}}}\n";
  for (int i = 0; i < balls; ++i) {
    const int x = -56 + 16 * (i % 8);
    const int y = -24 + 16 * (i / 8);
    text += "  - {name: ball" + std::to_string(i) + ", inside: {sphere: {center: [" +
            std::to_string(x) + ", " + std::to_string(y) + ", 0], radius: 6}}}\n";
  }
  return text;
}

TEST(ManyLayers, BesideAComplementCompile) {
  for (const int balls : {7, 8, 9, 12, 24}) {
    SCOPED_TRACE(balls);
    ScenePtr scene;
    ASSERT_NO_THROW(scene = compile(parseScene(room(balls), "room")));
    EXPECT_EQ(scene->regions().size(), static_cast<std::size_t>(balls) + 2);
    EXPECT_EQ(scene->regionAt({0.0, 0.0, 0.03}), kOutside);
    EXPECT_EQ(scene->regionAt({0.0, 0.0, 0.09}), scene->regionNamed("rock"));
    EXPECT_EQ(scene->regionAt({-0.056, -0.024, 0.0}), scene->regionNamed("ball0"));
    EXPECT_EQ(scene->regionAt({5.0, 5.0, 5.0}), scene->regionNamed("rock"));
  }
}

TEST(ManyLayers, BesideAComplementThatIsNotTheFirst) {
  std::string text = "palpate: 1\nlength: mm\nlayers:\n";
  for (int i = 0; i < 10; ++i) {
    text += "  - {name: ball" + std::to_string(i) + ", inside: {sphere: {center: [" +
            std::to_string(-45 + 10 * i) + ", 0, 0], radius: 6}}}\n";
  }
  text += "  - {name: rock, inside: {complement: {sphere: {center: [0, 0, 0], radius: 80}}}}\n";
  ScenePtr scene;
  ASSERT_NO_THROW(scene = compile(parseScene(text, "room")));
  EXPECT_EQ(scene->regionAt({0.0, 0.0, 0.09}), scene->regionNamed("rock"));
  EXPECT_EQ(scene->regionAt({0.045, 0.0, 0.0}), scene->regionNamed("ball9"));
}

}  // namespace
}  // namespace palpate::test
