// Touching labels of one image, felt: they have one wall.

#include <gtest/gtest.h>

#include "lib/render/drive.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

void add(SceneDescription& scene, const char* name, const Vec3& center) {
  LayerDescription out;
  out.name = name;
  out.inside = std::make_shared<FieldSource>(sphere(center, 0.025));
  out.label_group = "scan";
  scene.layers.push_back(out);
}

TEST(LabelGroupFelt, FromOneLabelIntoTheOtherByTheirOneWall) {
  SceneDescription two;
  add(two, "a", mm(-15, 0, 0));
  add(two, "b", mm(15, 0, 0));
  two.start_region = "a";
  PortDescription port;
  port.name = "gap";
  port.from = "a";
  port.to = "b";
  two.ports = {port};
  Drive open(compile(two));
  (void)open.to(mm(-10, 3, 0));
  (void)open.walk(mm(10, 3, 0));
  EXPECT_EQ(open.region(), "b");
  EXPECT_EQ(open.events(), "gap") << "once, and never outside in between";
  two.ports.clear();
  Drive closed(compile(two));
  (void)closed.to(mm(-10, 3, 0));
  EXPECT_TRUE(isNear(closed.walk(mm(3, 3, 0)).force, Vec3(-3, 0, 0), 1e-7));
  EXPECT_EQ(closed.region(), "a");
  // Within a, up along the shared wall to the rim: held by the wall and the skin together.
  const TickResult& corner = closed.walk(mm(3, 23, 0));
  EXPECT_TRUE(isNear(corner.proxy, mm(0, 20, 0), 1e-7));
  EXPECT_TRUE(isNear(corner.force, 1000.0 * (corner.proxy - closed.hip()), 1e-4));
}

}  // namespace
}  // namespace palpate::test
