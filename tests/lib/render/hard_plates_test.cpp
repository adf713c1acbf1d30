// Nothing is passed at any speed: thin plates and sheets, obliquely, at every phase of the tick.

#include <gtest/gtest.h>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

constexpr int kPhases = 200;

/// A sheet in the plane z = 0, 300 mm across; the same region on both sides.
ScenePtr sheetScene() {
  SceneDescription description;
  SheetDescription sheet;
  sheet.name = "leaf";
  sheet.on = std::make_shared<FieldSource>(halfSpace(Vec3(0.0), Vec3(0, 0, 1)));
  sheet.where = std::make_shared<FieldSource>(cylinder(Vec3(0.0), Vec3(0, 0, 1), 0.15, 0.02));
  description.sheets.push_back(sheet);
  return compile(description);
}

/// Counts the runs in which the proxy came out on the other side of z = 0 in the frame `pose`. The
/// hand comes from above (or below), `slant` degrees from the normal, and goes on to 60 mm beyond.
int tunnelled(const ScenePtr& scene, const Pose& pose, double half, double speed, double slant,
              bool from_below) {
  int passed = 0;
  const double step = speed * Drive::kTick;
  const double side = from_below ? -1.0 : 1.0;
  const Vec3 way = glm::normalize(Vec3(std::sin(slant * kDegree), 0.3 * std::sin(slant * kDegree),
                                       -side * std::cos(slant * kDegree)));
  for (int phase = 0; phase < kPhases; ++phase) {
    Drive drive(scene);
    const Vec3 hit = mm(-15, 5, 0);
    const double ahead = 0.03 + step * phase / kPhases;
    bool through = false;
    for (double s = -ahead; s < 0.08; s += step) {
      const TickResult& out = drive.to(pose.apply(hit + s * way));
      through = through || side * pose.applyInverse(out.proxy).z < half - 1e-9;
    }
    // Held where it hit, and pushed back out: the proxy is the closest point of the near face.
    const Vec3 hip = pose.applyInverse(drive.hip());
    const Vec3 force = glm::transpose(pose.rotation) * drive.last().force;
    const Vec3 expected(0, 0, kDefaultK * (side * half - hip.z));
    through = through || !drive.last().contact || glm::length(force - expected) > 1e-5;
    passed += through ? 1 : 0;
  }
  return passed;
}

TEST(HardPlates, AnalyticPlatesAreNeverTunnelled) {
  const Pose turned{rotationAbout(Vec3(1, 2, 3), 0.8), mm(10, -20, 5)};
  for (const double thickness : {1e-3, 0.1e-3}) {
    const ScenePtr scene = sceneOfSolid(place(box(Vec3(0.0), Vec3(0.3, 0.3, thickness)), turned));
    for (const double speed : {1.0, 5.0, 20.0}) {
      for (const double slant : {0.0, 30.0, 60.0}) {
        for (const bool below : {false, true}) {
          EXPECT_EQ(tunnelled(scene, turned, 0.5 * thickness, speed, slant, below), 0)
              << thickness << " m at " << speed << " m/s, " << slant << " degrees" << below;
        }
      }
    }
  }
}

TEST(HardPlates, SheetsAreNeverTunnelled) {
  const ScenePtr scene = sheetScene();
  for (const double speed : {1.0, 5.0, 20.0}) {
    for (const double slant : {0.0, 30.0, 60.0}) {
      for (const bool below : {false, true}) {
        EXPECT_EQ(tunnelled(scene, {}, 0.0, speed, slant, below), 0)
            << speed << " m/s, " << slant << " degrees" << below;
      }
    }
  }
}

TEST(HardPlates, BeyondItsEdgeASheetLetsPass) {
  Drive drive(sheetScene());
  (void)drive.to(mm(160, 0, 20));
  EXPECT_EQ(drive.walk(mm(160, 0, -20)).force, Vec3(0.0)) << "beside it";
  // From below the plate holds as well.
  EXPECT_EQ(drive.walk(mm(100, 0, -20)).force, Vec3(0.0));
  EXPECT_TRUE(isNear(drive.walk(mm(100, 0, 2)).force, Vec3(0, 0, -2.0), 1e-9));
  // Slid over the edge, 2 mm deep, the proxy is released.
  for (double x = 100.0; x < 149.9; x += 0.5) {
    ASSERT_TRUE(isNear(drive.to(mm(x, 0, 2)).force, Vec3(0, 0, -2.0), 1e-9)) << x;
  }
  EXPECT_EQ(drive.walk(mm(151, 0, 2)).force, Vec3(0.0));
  EXPECT_EQ(drive.last().proxy, drive.hip());
}

}  // namespace
}  // namespace palpate::test
