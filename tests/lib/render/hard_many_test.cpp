// Many objects: those far away change nothing.

#include <gtest/gtest.h>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// Balls of 8 mm on a grid of 30 mm; the first one is at the origin.
std::vector<FieldPtr> balls(int count) {
  std::vector<FieldPtr> out{sphere(Vec3(0.0), 0.008)};
  for (int i = 0; static_cast<int>(out.size()) < count; ++i) {
    const int row = i / 10;
    const int layer = i / 100;
    const Vec3 center = mm(30.0 * (i % 10 - 5), 30.0 * (row % 10 - 5), 30.0 * (layer - 5));
    if (center != Vec3(0.0)) out.push_back(sphere(center, 0.008));
  }
  return out;
}

/// Presses, strokes around and leaves the ball at the origin.
void compare(const ScenePtr& one, const ScenePtr& many) {
  Drive alone(one);
  Drive among(many);
  Random random(5);
  Vec3 p = mm(0, 0, 12);
  Vec3 goal = p;
  int contacts = 0;
  for (int i = 0; i < 5000; ++i) {
    if (glm::length(goal - p) < 1e-3) goal = random.in({mm(-9, -9, -9), mm(9, 9, 9)});
    p += 0.3e-3 * glm::normalize(goal - p);
    const TickResult& a = alone.to(p);
    const TickResult& b = among.to(p);
    ASSERT_EQ(a.contact, b.contact) << i;
    ASSERT_TRUE(isNear(a.force, b.force, 1e-9)) << i;
    contacts += a.contact ? 1 : 0;
  }
  EXPECT_GT(contacts, 1000);
}

TEST(HardMany, AThousandPrimitivesFeelAsOne) {
  compare(sceneOfSolid(sphere(Vec3(0.0), 0.008)), sceneOfSolid(unite(balls(1000))));
}

TEST(HardMany, AThousandFromWithinTheUnionsComplement) {
  compare(sceneOfSolid(complement(sphere(Vec3(0.0), 0.008)), true),
          sceneOfSolid(complement(unite(balls(1000))), true));
}

TEST(HardMany, AThousandLayersFeelAsOne) {
  SceneDescription description;
  int i = 0;
  for (const FieldPtr& ball : balls(1000)) {
    LayerDescription layer;
    layer.name = "ball " + std::to_string(i++);
    layer.inside = std::make_shared<FieldSource>(ball);
    description.layers.push_back(layer);
  }
  compare(sceneOfSolid(sphere(Vec3(0.0), 0.008)), compile(description));
}

}  // namespace
}  // namespace palpate::test
