// Touching labels of one image, felt: the crease where the wall between them meets the surface of
// both.

#include <gtest/gtest.h>

#include "lib/render/shake.h"
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

TEST(LabelGroupFelt, TheCreaseHoldsAHandOutsideAndLetsItGo) {
  SceneDescription two;
  add(two, "a", mm(-15, 0, 0));
  add(two, "b", mm(15, 0, 0));
  const ScenePtr scene = compile(two);
  const double ring = 0.02;
  for (const double aside : {0.0, 0.3e-3, -0.4e-3}) {
    Drive drive(scene);
    (void)drive.to(mm(2, 40, 0));
    for (double angle = 0.0; angle < 6.0; angle += 0.01) {
      const Vec3 u(0, std::cos(angle), std::sin(angle));
      const Vec3 p = (ring - 0.003) * u + Vec3(aside, 0, 0);
      const TickResult& out = drive.to(p);
      ASSERT_EQ(out.region, kOutside);
      ASSERT_TRUE(isNear(out.proxy, ring * u, 1e-7)) << angle << " aside " << aside;
      ASSERT_TRUE(isNear(out.force, 1000.0 * (ring * u - p), 1e-4)) << angle;
    }
    const Vec3 away = 2.0 * ring * glm::normalize(drive.last().proxy);
    EXPECT_EQ(drive.walk(away).proxy, away);
    EXPECT_EQ(drive.last().force, Vec3(0.0));
  }
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
  // Inside `a` the hand goes up along the shared wall to the rim: the wall and the surface together
  // hold the proxy.
  const TickResult& corner = closed.walk(mm(3, 23, 0));
  EXPECT_TRUE(isNear(corner.proxy, mm(0, 20, 0), 1e-7));
  EXPECT_TRUE(isNear(corner.force, 1000.0 * (corner.proxy - closed.hip()), 1e-4));
}

TEST(LabelGroupFelt, RandomTicks) {
  SceneDescription description;
  add(description, "a", mm(-12, 0, 0));
  add(description, "b", mm(12, 0, 0));
  add(description, "c", mm(0, 15, 3));
  const auto port = [&](const char* name, const char* from, const char* to, double force) {
    PortDescription out;
    out.name = name;
    out.from = from;
    out.to = to;
    out.opens_at = force;
    description.ports.push_back(out);
  };
  // A high enough force that the hand, which wanders through the whole scene, is held for a tenth
  // of the time.
  port("skin", "outside", "?", 12.0);
  port("ab", "a", "b", 0.0);
  port("bc", "b", "c", 2.0);
  Bag bag{"label group", compile(description), 1000.0};
  bag.most_outside = 24.0;
  shake(bag);
}

}  // namespace
}  // namespace palpate::test
