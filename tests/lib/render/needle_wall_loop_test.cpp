// A needle whose tip is held by a wall while the hand goes on: friction along the shaft must not give energy there.

#include <gtest/gtest.h>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

// Along a slanting wall the shaft is drawn in or out a little, with the hand near the wall or far beyond it: friction
// that turned round out there would be given back over the way to the wall.
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

}  // namespace
}  // namespace palpate::test
