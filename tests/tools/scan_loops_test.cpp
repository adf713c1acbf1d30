// A hand in the loop on baked scans: as calm as with the brute-force oracle on the same grid.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "devices/oracle_renderer.h"
#include "palpate/devices/stability.h"
#include "palpate/scene/scene.h"
#include "palpate/vdb/register.h"
#include "support/loops/loop_limit.h"
#include "support/loops/loop_run.h"
#include "support/scan_folder.h"
#include "support/temp_file.h"
#include "vdb/debian_scans.h"

namespace palpate::loops {
namespace {

using testing::TempFolder;

constexpr double kWall = 1000.0;  // [N/m]

ScenePtr sceneOf(const std::string& file) {
  SceneRegistry registry;
  vdb::registerKinds(registry);
  return compile(readScene(file, registry));
}

struct Place {
  Vec3 at{0.0};   ///< [m] on the surface
  Vec3 out{0.0};  ///< [-] unit, out of it
};

/// Points where rays from all around towards the middle of a box first meet the surface of `field`.
std::vector<Place> placesOn(const Field& field, int count) {
  const Box3 box = field.bounds();
  const Vec3 middle = 0.5 * (box.lo + box.hi);
  const double radius = 0.5 * glm::length(box.hi - box.lo);
  std::vector<Place> out;
  for (int i = 0; i < count; ++i) {
    // Evenly spread over the sphere: Fibonacci's spiral.
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double across = std::sqrt(1.0 - z * z);
    const Vec3 way(across * std::cos(turn), across * std::sin(turn), z);
    constexpr double kStep = 0.2e-3;  // [m] finer than the voxels
    double outside = radius;
    while (outside > 0.0 && field.value(middle + (outside - kStep) * way) > 0.0) outside -= kStep;
    if (!(outside > 0.0)) continue;
    double inside = outside - kStep;
    for (int k = 0; k < 40; ++k) {
      const double half = 0.5 * (outside + inside);
      (field.value(middle + half * way) > 0.0 ? outside : inside) = half;
    }
    const Vec3 at = middle + outside * way;
    out.push_back({at, glm::normalize(field.sample(at).gradient)});
  }
  return out;
}

void expectCalm(const ScenePtr& scene, const std::string& name) {
  const bool is_slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const FieldPtr field = scene->regions()[scene->regionNamed("bone")].field;
  const auto ours = makeLoopRenderer("constraint", scene);
  OracleRenderer truth(scene);
  const std::vector<double> rates =
      is_slow ? std::vector<double>{1000.0, 4000.0, 10000.0} : std::vector<double>{1000.0};
  int felt = 0;
  for (const Place& place : placesOn(*field, is_slow ? 12 : 4)) {
    for (const char* device : {"excalibur", "falcon", "touch", "omega_3"}) {
      for (const double rate : rates) {
        const devices::LoopModel loop = loopModelOf({name, "constraint", device, "relaxed", rate});
        const double stiffness = 0.8 * devices::budgetOf(loop).stiffness();
        LoopSetting setting{
            .loop = loop,
            .hand = pressOn(place.at, place.out, depthOfForce(loop, stiffness, 1.0), 1.3)};
        setting.gain = stiffness / kWall;
        const LoopOutcome is = runLoop(*ours, setting, kWall);
        const LoopOutcome should = runLoop(truth, setting, kWall);
        std::printf("%s %s %g Hz: chatter %.3g N, oracle %.3g N; mean %.4g N, oracle %.4g N\n",
                    name.c_str(), device, rate, is.chatter, should.chatter, is.mean, should.mean);
        EXPECT_LE(is.chatter, 1.1 * should.chatter + 1e-3) << name << " on " << device;
        EXPECT_NEAR(is.mean, should.mean, 0.01) << name << " on " << device;
        felt += is.touches ? 1 : 0;
      }
    }
  }
  EXPECT_GT(felt, 0) << name;
}

TEST(ScanLoops, ABakedSkullIsAsCalmAsItsOracle) {
  const vdb::test::HeadCt ct = vdb::test::readHeadCt();
  const TempFolder folder;
  // A cap of the skull: every slice of the scan from above the eyes on.
  (void)vdb::test::writePart(ct, {40, 40, 67}, {215, 215, ct.size[2] - 1}, folder);
  expectCalm(sceneOf(folder.file("skull.yaml", R"(palpate: 1
length: mm
images: {head: {file: head.mhd}}
materials: {bone: {stiffness: 1000 N/m}}
layers:
  - {name: bone, threshold: {image: head, above: 300}, wall: bone}
)")),
             "skull");
}

TEST(ScanLoops, ABakedVertebraIsAsCalmAsItsOracle) {
  const std::string file = palpate::testing::scanPath("vertebra/subregions.nii.gz");
  PALPATE_NEEDS_SCAN(file);
  const TempFolder folder;
  expectCalm(sceneOf(folder.file("vertebra.yaml", R"(palpate: 1
length: mm
images: {spine: {file: )" + file + R"(}}
materials: {bone: {stiffness: 1000 N/m}}
layers:
  - {name: bone, threshold: {image: spine, above: 0.5}, wall: bone}
)")),
             "vertebra");
}

}  // namespace
}  // namespace palpate::loops
