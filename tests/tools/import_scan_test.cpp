// palpate import on real scans, compared with numpy and scipy, which read the same files.

#include <cmath>
#include <cstdio>

#include "support/scan_folder.h"
#include "tools/imported.h"
#include "vdb/python_oracle.h"

namespace palpate::testing {
namespace {

const std::string kData = scansFolder();
const char* const kOracle = "tools/scan_oracle.py";

struct Ray {
  Vec3 from{0.0};  ///< [mm]
  Vec3 direction{0.0};
};

/// Where a probe would be: [mm] along the ray to the body, and from there to each group of regions;
/// -1: never. Regions are queried in steps of 0.25 mm.
std::vector<std::vector<double>> depths(const TempFolder& folder, const std::string& scene,
                                        const std::vector<Ray>& rays, double length,
                                        const std::vector<std::vector<std::string>>& groups) {
  constexpr double kStep = 0.25;
  const int steps = static_cast<int>(length / kStep);
  std::string points = "x,y,z\n";
  char line[96];
  for (const Ray& ray : rays) {
    for (int i = 0; i < steps; ++i) {
      const Vec3 p = ray.from + i * kStep * ray.direction;
      std::snprintf(line, sizeof line, "%.9g,%.9g,%.9g\n", p.x, p.y, p.z);
      points += line;
    }
  }
  (void)folder.file("points.csv", points);
  const Json json = run(folder, {"query", scene, "--points", "points.csv", "--json"});
  std::vector<std::vector<double>> all;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    int skin = -1;
    std::vector<double> found(groups.size(), -1.0);
    for (int i = 0; i < steps; ++i) {
      const auto at = r * static_cast<std::size_t>(steps) + static_cast<std::size_t>(i);
      const std::string region = json["points"][at]["region"];
      if (skin < 0 && region != "outside") skin = i;
      for (std::size_t g = 0; g < groups.size(); ++g) {
        const bool is_in = std::find(groups[g].begin(), groups[g].end(), region) != groups[g].end();
        if (is_in && found[g] < 0.0) found[g] = (i - skin) * kStep;
      }
    }
    all.push_back({skin * kStep});
    all.back().insert(all.back().end(), found.begin(), found.end());
  }
  return all;
}

/// Compares with the march through the voxels, ray by ray; returns how many groups were met.
int expectDepths(const std::vector<std::vector<double>>& ours,
                 const std::vector<std::vector<double>>& voxels, double voxel) {
  int met = 0;
  EXPECT_EQ(ours.size(), voxels.size());
  for (std::size_t r = 0; r < std::min(ours.size(), voxels.size()); ++r) {
    EXPECT_EQ(ours[r].size(), voxels[r].size());
    for (std::size_t n = 0; n < ours[r].size(); ++n) {
      std::printf("  ray %zu %s: %.2f mm, voxels %.2f mm\n", r,
                  n == 0   ? "skin"
                  : n == 1 ? "muscle"
                           : "bone",
                  ours[r][n], voxels[r][n]);
      EXPECT_NEAR(ours[r][n], voxels[r][n], voxel) << "ray " << r << " group " << n;
      met += n > 0 && voxels[r][n] >= 0.0 ? 1 : 0;
    }
  }
  return met;
}

std::string raysFile(const TempFolder& folder, const std::vector<Ray>& rays) {
  std::string text;
  char line[160];
  for (const Ray& ray : rays) {
    std::snprintf(line, sizeof line, "%.9g %.9g %.9g %.9g %.9g %.9g\n", ray.from.x, ray.from.y,
                  ray.from.z, ray.direction.x, ray.direction.y, ray.direction.z);
    text += line;
  }
  return folder.file("rays.txt", text);
}

TEST(ImportScan, RegionsOfAnAbdomenAreThoseOfScipy) {
  const std::string labels = kData + "/abdomen/example_seg.nii.gz";
  PALPATE_NEEDS_SCAN(labels);
  const std::string ct = kData + "/abdomen/example_ct.nii.gz";
  const TempFolder folder;
  const Json json = run(folder, {"import", labels, "--names", kData + "/abdomen/labels.csv",
                                 "--image", ct, "--skin", "-300", "--dry-run", "--json"});
  const auto expected = vdb::test::askScript(kOracle, "body", {ct, "-300", labels});
  std::map<int, std::uint64_t> voxels;
  for (std::size_t row = 1; row < expected.size(); ++row) {
    voxels[static_cast<int>(expected[row][0])] = static_cast<std::uint64_t>(expected[row][1]);
  }
  std::size_t compared = 0;
  for (const Json& region : json["regions"]) {
    if (region["name"] == "soft_tissue") {
      EXPECT_EQ(region["voxels"], static_cast<std::uint64_t>(expected[0][0]));
      continue;
    }
    ASSERT_EQ(region["labels"].size(), 1U);
    EXPECT_EQ(region["voxels"], voxels.at(region["labels"][0])) << region["name"];
    ++compared;
  }
  EXPECT_EQ(compared, 61U);
  EXPECT_EQ(compared + 1, voxels.size());
}

TEST(ImportScan, MuscleAndBoneOfAnAbdomenAreWhereTheLabelsAre) {
  const std::string labels = kData + "/abdomen/example_seg.nii.gz";
  PALPATE_NEEDS_SCAN(labels);
  const std::string ct = kData + "/abdomen/example_ct.nii.gz";
  const TempFolder folder;
  const Json json = run(
      folder, {"import", labels, "--labels", "77,78,80-83", "--region", "bone=77-78", "--region",
               "muscle=80-83", "--image", ct, "--skin", "-300", "-o", "abdomen.yaml", "--json"});
  ASSERT_EQ(json["regions"].size(), 3U);
  // From behind and from the left, at heights where there is a hip, and where rays do not graze it.
  const Json* bone = nullptr;
  for (const Json& region : json["regions"]) {
    if (region["name"] == "bone") bone = &region;
  }
  ASSERT_NE(bone, nullptr);
  const auto number = [&](const char* end, int axis) {
    return bone->at("bounds_m")[end][static_cast<std::size_t>(axis)].get<double>() * 1e3;
  };
  std::vector<Ray> rays;
  for (int i = 0; i < 5; ++i) {
    const double z = number("lo", 2) + (0.3 + 0.12 * i) * (number("hi", 2) - number("lo", 2)) + 0.4;
    const double x =
        number("lo", 0) + (0.12 + 0.03 * i) * (number("hi", 0) - number("lo", 0)) + 0.4;
    const double y = 0.5 * (number("lo", 1) + number("hi", 1)) + 0.4;
    rays.push_back({Vec3(x, number("lo", 1) - 180.0, z), Vec3(0, 1, 0)});
    rays.push_back({Vec3(number("lo", 0) - 180.0, y - 4.0 * i, z), Vec3(1, 0, 0)});
  }
  const auto ours = depths(folder, "abdomen.yaml", rays, 400.0, {{"muscle"}, {"bone"}});
  const auto voxels = vdb::test::askScript(
      kOracle, "rays", {labels, ct, "-300", raysFile(folder, rays), "80,81,82,83;77,78"});
  // Within one voxel, plus the step length of both marches.
  EXPECT_GE(expectDepths(ours, voxels, 3.0 + 0.3), 12);
}

TEST(ImportScan, AShellIsFeltOnBothFacesAndItsCoreReachedThroughItAlone) {
  PALPATE_NEEDS_SCAN(kData + "/vertebra/subregions.nii.gz");
  const TempFolder folder;
  (void)folder.file("names.csv", "value,name\n49,vertebra shell\n50,vertebra core\n");
  (void)folder.file("table.yaml", kBoneThatOpens);
  const Json json =
      run(folder, {"import", kData + "/vertebra/subregions.nii.gz", "--names", "names.csv",
                   "--labels", "49,50", "--materials", "table.yaml", "-o", "v.yaml", "--json"});
  Json core;
  for (const Json& region : json["regions"]) {
    if (region["name"] == "vertebra core") core = region;
  }
  ASSERT_EQ(core["within"], "vertebra shell");
  ASSERT_EQ(core["touches"].size(), 1U);

  // Rays through the middle of one of the three vertebrae, from three sides and out at the opposite
  // side. Along z the others are 18 mm and more away.
  const Vec3 middle(-25.5, -156.0, -64.2);
  const auto reach = [](int side) { return side / 2 == 2 ? 16.5 : 45.0; };
  const auto point = [](const Vec3& p) {
    char text[96];
    std::snprintf(text, sizeof text, "%.4f,%.4f,%.4f", p.x, p.y, p.z);
    return std::string(text);
  };
  const auto felt = [&](const std::string& scene, const Vec3& from, const Vec3& to) {
    const Json touch = run(folder, {"touch", scene, "--insert", point(from), point(to), "--speed",
                                    "20mm/s", "--json"});
    std::vector<std::string> order;
    std::vector<double> peak;
    for (const Json& region : touch["regions"]) {
      order.push_back(region["region"]);
      peak.push_back(region["peak_force_N"]);
    }
    return std::pair(order, peak);
  };
  for (const int side : {0, 3, 4}) {  // one side for each axis
    Vec3 way(0.0);
    way[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
    const auto [order, peak] =
        felt("v.yaml", middle - reach(side) * way, middle + reach(side) * way);
    SCOPED_TRACE("side " + std::to_string(side));
    ASSERT_GE(order.size(), 5U);
    // The core is nowhere next to the outside.
    for (std::size_t n = 1; n < order.size(); ++n) {
      EXPECT_FALSE(order[n] == "vertebra core" && order[n - 1] != "vertebra shell");
      EXPECT_FALSE(order[n - 1] == "vertebra core" && order[n] != "vertebra shell");
    }
    const auto in = std::find(order.begin(), order.end(), "vertebra core");
    ASSERT_NE(in, order.end());
    const auto n = static_cast<std::size_t>(in - order.begin());
    // The shell's outer face, its inner face, and on the far side in reverse order.
    EXPECT_NEAR(peak[n - 2], 3.0, 0.05);
    EXPECT_NEAR(peak[n - 1], 3.0, 0.05);
    EXPECT_NEAR(peak[n], 2.0, 0.05);
  }

  // With the project's table, bone stays closed: it is felt from outside and from within.
  (void)run(folder, {"import", kData + "/vertebra/subregions.nii.gz", "--labels", "49,50",
                     "--names", "names.csv", "--region", "bone shell=49", "--region",
                     "bone core=50", "-o", "closed.yaml", "--json"});
  const std::string closed = textOf(folder.path("closed.yaml"));
  EXPECT_EQ(closed.find("opens_at"), std::string::npos);
  (void)folder.file("inside.yaml", closed + "start: {region: bone core}\n");
  for (const int side : {0, 3, 4}) {
    Vec3 way(0.0);
    way[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
    const auto [outer, outer_peak] = felt("closed.yaml", middle - reach(side) * way, middle);
    EXPECT_EQ(outer, std::vector<std::string>{"outside"});
    EXPECT_GT(outer_peak[0], 5.0);
    const auto [inner, inner_peak] = felt("inside.yaml", middle, middle + reach(side) * way);
    EXPECT_EQ(inner, std::vector<std::string>{"bone core"});
    EXPECT_GT(inner_peak[0], 5.0);
  }
}

TEST(ImportScan, OfSegmentsThatOverlapTheLaterHasTheVoxels) {
  const std::string file = kData + "/chest_segnrrd/SegmentationOverlapping.seg.nrrd";
  PALPATE_NEEDS_SCAN(file);
  const TempFolder folder;
  const CommandResult result =
      runPalpate({"import", file, "-o", "chest.yaml", "--json"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("overlap"), std::string::npos) << result.err;
  const auto expected = vdb::test::askScript(kOracle, "segments", {file});
  const std::vector<std::string> names = {"ribs",
                                          "cervical vertebral column",
                                          "thoracic vertebral column",
                                          "lumbar vertebral column",
                                          "right lung",
                                          "left lung",
                                          "tissue",
                                          "overlapping sphere"};
  ASSERT_EQ(expected.size(), names.size());
  double shared = 0.0;
  const Json json = parseOnly(result);
  ASSERT_EQ(json["regions"].size(), names.size());
  for (const Json& region : json["regions"]) {
    const auto at = std::find(names.begin(), names.end(), region["name"].get<std::string>());
    ASSERT_NE(at, names.end()) << region["name"];
    const auto& voxels = expected[static_cast<std::size_t>(at - names.begin())];
    EXPECT_EQ(region["voxels"].get<double>(), voxels[1]) << region["name"];
    shared += voxels[0] - voxels[1];
  }
  EXPECT_EQ(shared, 15514.0);
  EXPECT_EQ(runPalpate({"info", "chest.yaml"}, folder.path()).exit_code, 0);
}

}  // namespace
}  // namespace palpate::testing
