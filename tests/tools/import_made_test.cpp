// Scans made by the tests, through the command: they are imported, and felt where their closed
// forms have walls.

#include <cmath>
#include <cstdio>
#include <map>

#include "tools/imported.h"
#include "vdb/made_scans.h"

namespace palpate::testing {
namespace {

using vdb::Image;
using vdb::test::Limb;

const Json& regionOf(const Json& json, const std::string& name) {
  for (const Json& region : json["regions"]) {
    if (region["name"] == name) return region;
  }
  ADD_FAILURE() << "no region " << name;
  return json;
}

// Labels for bone and muscle, gray values for the skin, both oblique. All walls except the bone's
// open at the lightest touch.
TEST(ImportMade, LayersOfALimbAreFeltAtTheRadiiOfItsCylinders) {
  const TempFolder folder;
  const Limb limb;
  const Mat3 axes = vdb::test::obliqueAxes(Vec3(1, 1, 1));
  Image labels = limb.labels(axes);
  for (float& label : labels.values) label = label > 2.0F ? 0.0F : label;  // fat has no label
  const Image ct = limb.scan(axes);
  (void)vdb::test::writeNifti(labels, folder, "labels.nii.gz");
  (void)vdb::test::writeDicom(ct, folder, "series");
  (void)folder.file("names.csv", "value,name\n1,femur\n2,vastus muscle\n");
  (void)folder.file("table.yaml", R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: a needle}
stiffest: {value: 2000 N/m, basis: assumed, source: a device}
tissues:
  bone: {labels: ["femur"], stiffness: {value: 1000 N/m, basis: assumed, source: round}}
  skin: {labels: ["skin"], stiffness: {value: 400 N/m, basis: assumed, source: round}, opens_at: {value: 0 N, basis: assumed, source: open}}
  fat: {labels: ["fat"], stiffness: {value: 100 N/m, basis: assumed, source: round}}
  muscle: {labels: ["*muscle*"], stiffness: {value: 500 N/m, basis: assumed, source: round}, opens_at: {value: 0 N, basis: assumed, source: open}}
)");
  const Json json =
      run(folder, {"import", "labels.nii.gz", "--names", "names.csv", "--image", "series", "--skin",
                   "-550", "--materials", "table.yaml", "-o", "limb.yaml", "--json"});
  std::map<std::string, std::uint64_t> voxels;
  for (std::size_t v = 0; v < labels.values.size(); ++v) {
    const float label = labels.values[v];
    if (label == 1.0F) {
      ++voxels["femur"];
    } else if (label == 2.0F) {
      ++voxels["vastus muscle"];
    } else if (ct.values[v] > -550.0F) {
      ++voxels["soft_tissue"];
    }
  }
  for (const auto& [name, count] : voxels) EXPECT_EQ(regionOf(json, name)["voxels"], count) << name;

  // From 35 mm in to 6.5 mm, 1.5 mm into the bone, from eight sides; between two of them the hand
  // is never nearer than 32 mm.
  constexpr double kDepth = 1.5;
  std::vector<Vec3> points, ways;
  for (int n = 0; n < 8; ++n) {
    const Vec3 way = limb.outwards(0.2 + n * 0.25 * 3.14159265);
    const Vec3 middle = limb.center + (n - 3.5) * 2.0 * limb.axis;
    ways.push_back(way);
    points.insert(points.end(), {middle + 35.0 * way, middle + (Limb::kBone - kDepth) * way,
                                 middle + 35.0 * way});
  }
  const std::vector<TracedTick> ticks = touched(folder, "limb.yaml", points, "20mm/s");
  std::size_t tick = 0;
  for (std::size_t n = 0; n < ways.size(); ++n) {
    const Vec3 end = points[3 * n + 1];
    std::vector<std::string> order;
    std::vector<double> radii;
    // The next approach begins outside, where the hand is farthest out.
    while (limb.radius(ticks[tick].hand) < 34.99) ++tick;
    while (glm::length(ticks[tick].hand - end) > 0.011) {
      if (ticks[tick].region != "outside" &&
          (order.empty() || order.back() != ticks[tick].region)) {
        order.push_back(ticks[tick].region);
        radii.push_back(limb.radius(ticks[tick].hand));
      }
      ++tick;
    }
    ASSERT_EQ(order, (std::vector<std::string>{"soft_tissue", "vastus muscle"})) << n;
    const TracedTick& last = ticks[tick];
    const double force = glm::length(last.force);
    std::printf("  skin at %.2f mm, muscle at %.2f mm, bone at %.2f mm, %.3f N\n", radii[0],
                radii[1], limb.radius(last.proxy), force);
    // Gray values give the radius to a tenth of a voxel and a tick, labels to a quarter of a voxel.
    EXPECT_NEAR(radii[0], Limb::kBody, 0.1);
    EXPECT_NEAR(radii[1], Limb::kMuscle, 0.25);
    EXPECT_NEAR(limb.radius(last.proxy), Limb::kBone, 0.25);
    // K times the depth, to the same quarter of a voxel; the force is straight outwards only to
    // some degrees, the error of labels.
    EXPECT_NEAR(force, 1000.0 * kDepth * 1e-3, 1000.0 * 0.25e-3);
    EXPECT_GT(glm::dot(last.force, ways[n]), 0.97 * force);
    EXPECT_NEAR(force, glm::length(last.hand - last.proxy),
                1e-5);  // 1000 N/m: a newton for each mm
  }
}

/// A shell of 4 mm around a core, each with its own label, and the table that opens their walls at
/// 3 N and 2 N.
void writeBall(const TempFolder& folder) {
  (void)vdb::test::writeNifti(
      vdb::test::imageAround(Vec3(0.0), vdb::test::obliqueAxes(Vec3(1, 1, 1.2)), 40.0,
                             [](const Vec3& mm) {
                               const double r = glm::length(mm);
                               return r < 12.0 ? 50 : r < 16.0 ? 49 : 0;
                             }),
      folder, "ball.nii.gz");
  (void)folder.file("names.csv", "value,name\n49,shell\n50,core\n");
  (void)folder.file("table.yaml", kBoneThatOpens);
}

TEST(ImportMade, AShellIsFeltOnBothFacesAndItsCoreReachedThroughItAlone) {
  const TempFolder folder;
  writeBall(folder);
  const Json json = run(folder, {"import", "ball.nii.gz", "--names", "names.csv", "--materials",
                                 "table.yaml", "-o", "ball.yaml", "--json"});
  EXPECT_EQ(regionOf(json, "core")["within"], "shell");
  EXPECT_EQ(regionOf(json, "core")["touches"].size(), 1U);
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0, -0.6, 0.8), glm::normalize(Vec3(-1, 2, 3))}) {
    const Json touch = run(folder, {"touch", "ball.yaml", "--insert", pointText(-30.0 * way),
                                    pointText(30.0 * way), "--speed", "20mm/s", "--json"});
    std::vector<std::string> order;
    std::vector<double> peak;
    for (const Json& region : touch["regions"]) {
      order.push_back(region["region"]);
      peak.push_back(region["peak_force_N"]);
    }
    ASSERT_EQ(order, (std::vector<std::string>{"outside", "shell", "core", "shell", "outside"}));
    // Into the shell and into the core, then back out of both.
    EXPECT_NEAR(peak[0], 3.0, 0.05);
    EXPECT_NEAR(peak[1], 3.0, 0.05);
    EXPECT_NEAR(peak[2], 2.0, 0.05);
    EXPECT_NEAR(peak[3], 2.0, 0.05);
  }
}

TEST(ImportMade, WhereSegmentsOverlapTheLaterIsFelt) {
  const TempFolder folder;
  const auto ball = [](double x, double radius) {
    return vdb::test::imageAround(
        Vec3(0.0), vdb::test::obliqueAxes(Vec3(1, 1, 1)), 44.0,
        [=](const Vec3& mm) { return glm::length(mm - Vec3(x, 0, 0)) < radius ? 1 : 0; });
  };
  // The later ball is stiffer, and sticks out of the other one.
  const vdb::test::Segment soft{"soft", ball(-4.0, 14.0)}, hard{"hard", ball(8.0, 10.0)};
  (void)vdb::test::writeSegments({soft, hard}, folder, "two.seg.nrrd");
  (void)folder.file("table.yaml", R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: a needle}
stiffest: {value: 2000 N/m, basis: assumed, source: a device}
tissues:
  hard: {labels: ["hard"], stiffness: {value: 900 N/m, basis: assumed, source: round}}
  soft: {labels: ["soft"], stiffness: {value: 300 N/m, basis: assumed, source: round}}
)");
  const CommandResult result = runPalpate(
      {"import", "two.seg.nrrd", "--materials", "table.yaml", "-o", "two.yaml", "--json"},
      folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("in several segments"), std::string::npos) << result.err;
  std::uint64_t left = 0, later = 0;
  for (std::size_t v = 0; v < soft.voxels.values.size(); ++v) {
    later += hard.voxels.values[v] != 0.0F ? 1U : 0U;
    left += soft.voxels.values[v] != 0.0F && hard.voxels.values[v] == 0.0F ? 1U : 0U;
  }
  const Json json = parseOnly(result);
  EXPECT_EQ(regionOf(json, "soft")["voxels"], left);
  EXPECT_EQ(regionOf(json, "hard")["voxels"], later);

  // A point inside both balls belongs to the later one.
  const Json query = run(folder, {"query", "two.yaml", "--json", "--at", "4,0,0", "-8,0,0"});
  EXPECT_EQ(query["points"][0]["region"], "hard");
  EXPECT_EQ(query["points"][1]["region"], "soft");
  // Press 1 mm deep at either end, where only one of them is.
  struct Press {
    Vec3 wall;
    Vec3 way;
    double stiffness;
  };
  for (const Press& press :
       {Press{{-18, 0, 0}, {1, 0, 0}, 300.0}, Press{{18, 0, 0}, {-1, 0, 0}, 900.0}}) {
    const std::vector<TracedTick> ticks = touched(
        folder, "two.yaml", {press.wall - 4.0 * press.way, press.wall + press.way}, "20mm/s");
    // Within a quarter of a voxel of 1 mm.
    EXPECT_NEAR(glm::length(ticks.back().force), press.stiffness * 1e-3, press.stiffness * 0.25e-3);
  }
}

TEST(ImportMade, AFolderOfSlicesIsAnImageOfTheCommandToo) {
  const TempFolder folder;
  const Limb limb;
  const Image made = limb.scan(vdb::test::obliqueAxes(Vec3(1.2, 1.5, 2.0)));
  (void)vdb::test::writeDicom(made, folder, "series");
  const Json info = run(folder, {"info", "series", "--json"})["files"][0];
  EXPECT_EQ(info["size"], Json(made.size));
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t r = 0; r < 3; ++r) {
      EXPECT_NEAR(info["axes_m"][a][r].get<double>(),
                  made.axes[static_cast<int>(a)][static_cast<int>(r)], 1e-9);
    }
  }
  // Deep inside bone and muscle, gray values are constant.
  const Json query = run(folder, {"query", "series", "--json", "--at", pointText(limb.center),
                                  pointText(limb.center + 12.0 * limb.outwards(1.0))});
  EXPECT_NEAR(query["points"][0]["value"].get<double>(), Limb::kBoneHu, 1e-6);
  EXPECT_NEAR(query["points"][1]["value"].get<double>(), Limb::kMuscleHu, 1e-6);
}

}  // namespace
}  // namespace palpate::testing
