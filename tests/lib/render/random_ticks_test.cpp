// Random ticks: whatever the hand does, the proxy passes through no wall, no region changes without
// an event, and the force agrees with the proxy.

#include <gtest/gtest.h>

#include "lib/render/shake.h"

namespace palpate::test {
namespace {

TEST(RandomTicks, Container) { shake({"container", sceneOf(containerText()), 1500.0}); }

TEST(RandomTicks, NestedBoxesThatShareFaces) {
  shake({"nested boxes", sceneOf(R"(
palpate: 1
length: mm
fields:
  shell: {box: {center: [0, 0, 0], size: [40, 40, 40]}}
  core: {box: {center: [5, 0, 5], size: [30, 20, 30]}}
  pit: {box: {center: [5, 0, 10], size: [10, 20, 20]}}
layers: [{name: shell, inside: shell}, {name: core, inside: core}, {name: pit, inside: pit}]
ports:
  - {name: top, between: [outside, pit]}
  - {name: flank, between: [pit, core], direction: in}
  - {name: crust, between: [core, shell], opens_at: 4 N, back: 1 N}
  - {name: way_out, between: [shell, outside], direction: in}
  - {name: shelf, between: [outside, core], opens_at: 6 N, after: [top]}
)"),
         1000.0});
}

TEST(RandomTicks, CompositeCylinder) {
  shake({"composite cylinder", sceneOf(R"(
palpate: 1
length: mm
fields:
  tube: {cylinder: {center: [0, 0, 0], axis: [1, 1, 0], radius: 20, height: 60}}
  inner: {cylinder: {center: [0, 0, 0], axis: [1, 1, 0], radius: 12, height: 60}}
  core: {cylinder: {center: [0, 0, 0], axis: [1, 1, 0], radius: 5, height: 80}}
  front: {half_space: {point: [0, 0, 0], normal: [1, 1, 0]}}
layers:
  - {name: tube, inside: tube}
  - {name: inner, inside: inner}
  - {name: core, inside: core}
ports:
  - {name: p1, between: [outside, tube], where: front}
  - {name: p2, between: [tube, inner], after: [p1]}
  - {name: p3, between: [inner, core], after: [p2]}
  - {name: vent, between: [core, outside], direction: in}
)"),
         1000.0});
}

TEST(RandomTicks, ThePaperStaysFiniteAndExplainsItsRegions) {
  const ScenePtr scene = sceneOf(containerText());
  Drive drive(scene, RendererKind::kPaper);
  Hand hand(78, scene->bounds().grownBy(0.02));
  RegionId region = kOutside;
  int events = 0;
  for (int i = 0; i < kTicks; ++i) {
    const Vec3 hip = hand.next();
    const TickResult out = drive.renderer().update({hip, Vec3(0.0)});
    ASSERT_TRUE(isFinite(out.force) && isFinite(out.proxy)) << i;
    ASSERT_TRUE(isExplained(*scene, region, out)) << i;
    ASSERT_TRUE(out.contact || out.force == Vec3(0.0)) << i;
    region = out.region;
    events += out.event_count;
  }
  EXPECT_GT(events, kTicks / 500);
}

}  // namespace
}  // namespace palpate::test
