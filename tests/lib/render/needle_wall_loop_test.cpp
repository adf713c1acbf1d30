// A wall holds a needle's tip while the hand goes on: friction along the shaft must not give energy
// there.

#include <gtest/gtest.h>

#include "lib/render/drive.h"
#include "lib/render/energy_loop.h"

namespace palpate::test {
namespace {

// Along a slanting wall the shaft is drawn in or out a little, with the hand near the wall or far
// beyond it: if friction reversed out there, it would give energy on the way back to the wall.
TEST(NeedleOnWall, FrictionThatTurnsRoundBeyondAWallGivesNoEnergy) {
  for (const double damping : {0.0, 100.0}) {
    Drive hand(sceneOf(
        "palpate: 1\nlength: mm\nmaterials: {m: {stiffness: 150 N/m, shaft: {stiffness: 1e5 N/m^2, "
        "in: {static: 18 N/m, "
        "kinetic: 10 N/m, damping: " +
        std::to_string(damping) +
        " N.s/m^2}}}, bone: {stiffness: 500 N/m}}\n"
        "layers: [{name: a, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, content: "
        "m, wall: m}, "
        "{name: bone, inside: {half_space: {point: [0, 0, -20], normal: [1, 0, 1]}}, wall: bone}]\n"
        "ports: [{name: p, between: [outside, a]}]\n"));
    (void)hand.walk(mm(0, 0, 5));
    (void)hand.walk(mm(0, 0, -20), 50e-6);
    const Vec3 into = glm::normalize(Vec3(-1.0, 0.0, -1.0));
    const Vec3 along = glm::normalize(Vec3(1.0, 0.0, -1.0));
    double work = 0.0;
    const auto go = [&](const Vec3& to) {
      const Vec3 from = hand.hip();
      const int n = 1000;
      for (int i = 1; i <= n; ++i) {
        const Vec3 last = hand.hip();
        const Vec3 force = hand.last().force;
        (void)hand.to(glm::mix(from, to, static_cast<double>(i) / n));
        work += 0.5 * glm::dot(force + hand.last().force, hand.hip() - last);
      }
    };
    for (int lap = 0; lap < 4; ++lap) {
      work = 0.0;
      const Vec3 wall = mm(0, 0, -20);
      const double slide = lap < 2 ? 0.6e-3 : -0.6e-3;
      go(wall + 6e-3 * into);
      go(wall + 6e-3 * into + slide * along);
      go(wall + slide * along);
      go(wall);
      std::printf("  lap %d: %.3g mJ\n", lap, work * 1e3);
      EXPECT_LE(work, 1e-9) << "lap " << lap;
    }
  }
}

// Tissue that is drawn along in every lap, and cut a little, gives back the energy that it got on
// the way in: in each lap the hand gets a little, and in total never more than it gave.
TEST(NeedleOnWall, TissueGivesBackOverManyLapsWhatItWasGivenOnTheWayIn) {
  const ScenePtr scene = sceneOf(R"(
palpate: 1
length: mm
materials:
  m: {stiffness: 1000 N/m}
  c: {stiffness: 500 N/m, cutting: 0.2 N, shaft: {stiffness: 1e5 N/m^2, in: {static: 18 N/m, kinetic: 10 N/m}}}
  bone: {stiffness: 2500 N/m}
layers:
  - {name: a, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: m, content: c}
  - {name: b, inside: {half_space: {point: [0, 0, -12], normal: [0.3, 0, 1]}}, wall: bone}
ports: [{name: p, between: [outside, a]}]
)");
  EnergyLoop loop;
  loop.center = mm(0.001132, -0.039672, -12.200781);
  loop.wave = {mm(-0.130909, 0.125635, -0.113092), mm(0.028430, -0.100823, -0.074355),
               mm(-0.059039, 0.038550, -0.079911), mm(0.064800, 0.083827, -0.102062)};
  LoopHand hand(scene, mm(0, 0, 10), loop, 4000);
  int giving = 0;
  for (int lap = 0; lap < 8; ++lap) {
    const double work = hand.work();
    const double held = hand.inTissue();
    hand.lap();
    if (hand.work() - work > 1e-7) ++giving;
    EXPECT_LE(hand.work() - work, held - hand.inTissue() + 1e-9) << "lap " << lap;
    EXPECT_LE(hand.work() + hand.inTissue(), 1e-9) << "lap " << lap;
  }
  // The laps did press on the wall: 2.3e-7 J a lap, out of 7.1e-5 J.
  EXPECT_EQ(giving, 7);
}

}  // namespace
}  // namespace palpate::test
