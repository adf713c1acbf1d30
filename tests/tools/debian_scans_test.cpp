// Scans from Debian packages, through the command: its imports, bakes and touches are compared with
// loops over the voxels themselves.

#include "vdb/debian_scans.h"

#include <cmath>
#include <cstdio>
#include <map>

#include "tools/imported.h"

namespace palpate::testing {
namespace {

using vdb::Image;
using vdb::test::HeadCt;
using vdb::test::mricron;

/// On the way straight in from `from`: the tick that first feels something, and the last one.
std::pair<TracedTick, TracedTick> wayIn(const std::vector<TracedTick>& ticks, const Vec3& from,
                                        const Vec3& to) {
  const Vec3 way = glm::normalize(to - from);
  std::pair<TracedTick, TracedTick> result;
  bool is_felt = false;
  double deepest = 0.0;
  for (const TracedTick& tick : ticks) {
    const Vec3 along = tick.hand - from;
    const double s = glm::dot(along, way);
    if (s < deepest || glm::length(along - s * way) > 1e-3 || s > glm::length(to - from) + 1e-3)
      continue;
    deepest = s;
    result.second = tick;
    if (!is_felt && glm::length(tick.force) > 0.0) {
      result.first = tick;
      is_felt = true;
    }
  }
  EXPECT_TRUE(is_felt);
  return result;
}

TEST(DebianScans, RegionsOfAnAtlasAreItsVoxelsUnderTheirNames) {
  const std::string atlas = mricron("aal.nii.gz");
  const TempFolder folder;
  const Json json =
      run(folder, {"import", atlas, "--names", mricron("aal.nii.txt"), "--dry-run", "--json"});
  const Image image = vdb::readImage(atlas);
  std::map<int, std::uint64_t> voxels;
  for (const float label : image.values) ++voxels[static_cast<int>(label)];
  std::map<std::string, std::uint64_t> wanted;
  std::ifstream table(mricron("aal.nii.txt"));
  int label = 0, code = 0;
  for (std::string name; table >> label >> name >> code;) wanted[name] = voxels.at(label);
  ASSERT_EQ(wanted.size(), 116U);
  EXPECT_EQ(json["regions"].size(), wanted.size());
  int sides = 0;
  for (const Json& region : json["regions"]) {
    const std::string name = region["name"];
    EXPECT_EQ(region["voxels"], wanted.at(name)) << name;
    EXPECT_NEAR(region["volume_m3"].get<double>(), static_cast<double>(wanted.at(name)) * 1e-9,
                1e-15);
    // x is to the right: regions that the table calls left are left of the middle, except for a few
    // voxels.
    const Json& bounds = region["bounds_m"];
    const double middle = bounds["lo"][0].get<double>() + bounds["hi"][0].get<double>();
    if (name.ends_with("_L") || name.ends_with("_R")) {
      EXPECT_EQ(middle < 0.0, name.ends_with("_L")) << name;
      ++sides;
    }
  }
  EXPECT_EQ(sides, 108);
}

// A nucleus of 1 mm voxels as a solid wall of 200 N/m, pressed from six sides.
TEST(DebianScans, ANucleusIsFeltWhereItsVoxelsBegin) {
  constexpr double kStiffness = 200.0;  // [N/m]
  constexpr int kPutamen = 73;
  const TempFolder folder;
  (void)folder.file("table.yaml", R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: a needle}
stiffest: {value: 2000 N/m, basis: assumed, source: a device}
tissues:
  nucleus: {labels: ["*"], stiffness: {value: 200 N/m, basis: assumed, source: round}}
)");
  (void)run(folder, {"import", mricron("aal.nii.gz"), "--names", mricron("aal.nii.txt"), "--labels",
                     "Putamen_L", "--materials", "table.yaml", "-o", "putamen.yaml", "--json"});
  const Image image = vdb::readImage(mricron("aal.nii.gz"));
  const auto is_in = [&](const Vec3& mm) {
    const Vec3 v = glm::round(image.toIndex(mm * 1e-3));
    return image.at(static_cast<int>(v.x), static_cast<int>(v.y), static_cast<int>(v.z)) ==
           static_cast<float>(kPutamen);
  };
  const Vec3 middle(-25, 2, 2);
  ASSERT_TRUE(is_in(middle));
  struct Ray {
    Vec3 from{0.0};
    Vec3 to{0.0};
    double face = 0.0;  ///< distance from `from` to the first voxel
  };
  std::vector<Ray> rays;
  std::vector<Vec3> points;
  for (const int side : {0, 2, 1, 3, 4, 5}) {
    Vec3 way(0.0);
    way[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
    // Along an axis from outside; faces of voxels are at half millimeters.
    Ray ray{middle - 44.5 * way, Vec3(0.0), 0.0};
    while (!is_in(ray.from + (ray.face + 0.5) * way)) ray.face += 1.0;
    ray.to = ray.from + (ray.face + 2.5) * way;
    rays.push_back(ray);
    // The last side but one is below and the last one above: go around in between.
    if (side == 5) points.push_back(middle + Vec3(60, 0, 0));
    points.insert(points.end(), {ray.from, ray.to, ray.from});
  }
  const std::vector<TracedTick> ticks = touched(folder, "putamen.yaml", points, "50mm/s");
  for (const Ray& ray : rays) {
    const Vec3 way = glm::normalize(ray.to - ray.from);
    const auto [first, last] = wayIn(ticks, ray.from, ray.to);
    const double along = glm::dot(first.hand - ray.from, way) - ray.face;
    const double across = along * glm::dot(glm::normalize(first.force), -way);
    // The spring law holds to the digits of the trace, and the force is straight out of the wall.
    const Vec3 out = last.proxy - last.hand;
    const double depth = glm::length(last.force) / kStiffness * 1e3;
    EXPECT_NEAR(depth, glm::length(out), 1e-4);
    EXPECT_GT(glm::dot(last.force, out), 0.9999 * glm::length(last.force) * glm::length(out));
    // Distance to the center of the nearest voxel outside.
    double nearest = 1e9;
    for (int n = 0; n < 17 * 17 * 17; ++n) {
      const Vec3 at = glm::round(last.hand) + Vec3(n % 17, n / 17 % 17, n / 289) - 8.0;
      if (!is_in(at)) nearest = std::min(nearest, glm::length(at - last.hand));
    }
    std::printf("  wall off %+.2f mm along, %+.2f across; depth %.2f mm, nearest outside %.2f mm\n",
                along, across, depth, nearest);
    // A smooth wall keeps each voxel's center on its side. Measured across the wall, it may thus be
    // off by half a voxel, and by slightly more where it bends.
    EXPECT_NEAR(across, 0.0, 0.7);
    // So the depth is not beyond the nearest center outside, and not more than a voxel's diagonal
    // in front of it.
    EXPECT_LT(depth, nearest + 0.15);
    EXPECT_GT(depth, nearest - std::sqrt(3.0) / 2.0);
  }
}

TEST(HeadCt, ASkullHasTheVolumeThatInVesaliusGivesIt) {
  const HeadCt ct = vdb::test::readHeadCt();
  const TempFolder folder;
  // The part of the image that holds bone, by the mask stored by InVesalius, with some air around
  // it.
  std::array<int, 3> lo = ct.size;
  std::array<int, 3> hi{};
  for (int k = 0; k < ct.size[2]; ++k) {
    for (int j = 0; j < ct.size[1]; ++j) {
      for (int i = 0; i < ct.size[0]; ++i) {
        if (ct.mask[ct.index(i, j, k)] == 0) continue;
        lo = {std::min(lo[0], i), std::min(lo[1], j), std::min(lo[2], k)};
        hi = {std::max(hi[0], i), std::max(hi[1], j), std::max(hi[2], k)};
      }
    }
  }
  for (std::size_t a = 0; a < 3; ++a) {
    lo[a] = std::max(lo[a] - 3, 0);
    hi[a] = std::min(hi[a] + 3, ct.size[a] - 1);
  }
  (void)vdb::test::writePart(ct, lo, hi, folder);
  // Values are integers: 226 and more are above 225.5. Voxels of 2 mm, for speed.
  (void)run(folder, {"bake", "head.mhd", "--above", "225.5", "--keep", "all", "--voxel", "2", "-o",
                     "skull.vdb", "--json"});
  const Json grid = run(folder, {"check", "skull.vdb", "--json"})["files"][0]["grids"][0];
  const double volume = grid["volume_m3"].get<double>() * 1e9;
  std::printf("  %.1f ml, InVesalius %.1f ml\n", volume * 1e-3, ct.surface_volume * 1e-3);
  // Two iso-surfaces of the same voxels, one smoothed and the other in coarse voxels: they differ
  // by 0.2 %, in fine voxels by 0.1 %.
  EXPECT_NEAR(volume / ct.surface_volume, 1.0, 0.005);
  EXPECT_TRUE(grid["findings"].empty()) << grid;
}

// Seven slices above the eyes, pressed along rows and columns of voxels.
TEST(HeadCt, ASkullIsFeltWhereItsHounsfieldUnitsCrossTheThreshold) {
  constexpr double kThreshold = 300.0;
  constexpr double kStiffness = 800.0;  // [N/m]
  constexpr int kFirst = 67;
  constexpr int kMiddle = 3;
  const HeadCt ct = vdb::test::readHeadCt();
  const TempFolder folder;
  const Image image = vdb::readImage(
      vdb::test::writePart(ct, {0, 0, kFirst}, {255, 255, kFirst + 2 * kMiddle}, folder));
  (void)folder.file("skull.yaml", R"(palpate: 1
length: mm
images: {head: {file: head.mhd}}
materials: {bone: {stiffness: 800 N/m}}
layers:
  - {name: skull, threshold: {image: head, above: 300}, wall: bone}
)");
  const auto world = [&](const std::array<int, 2>& ij) {
    return image.toWorld(Vec3(ij[0], ij[1], kMiddle)) * 1e3;
  };
  const auto value = [&](const std::array<int, 2>& ij) {
    return static_cast<double>(ct.values[ct.index(ij[0], ij[1], kFirst + kMiddle)]);
  };
  std::vector<Vec3> walls;
  std::vector<Vec3> ways;
  std::vector<Vec3> points;
  for (const int side : {0, 2, 1, 3}) {
    const std::size_t axis = side < 2 ? 0 : 1;
    const int step = side % 2 == 0 ? 1 : -1;
    std::array<int, 2> at = {128, 120};
    at[axis] = step > 0 ? 0 : 255;
    while (value(at) <= kThreshold) at[axis] += step;
    std::array<int, 2> before = at;
    before[axis] -= step;
    // Linear interpolation between the last voxel below and the first one above.
    const double share = (kThreshold - value(before)) / (value(at) - value(before));
    const Vec3 voxel = world(at) - world(before);
    walls.push_back(world(before) + share * voxel);
    ways.push_back(glm::normalize(voxel));
    // From above all slices down to the height of the ray, in, out, and up again.
    const Vec3 outside = walls.back() - 8.0 * ways.back();
    const Vec3 above = outside + Vec3(0, 0, 30);
    points.insert(points.end(), {above, outside, walls.back() + 1.5 * ways.back(), outside, above});
  }
  const std::vector<TracedTick> ticks = touched(folder, "skull.yaml", points, "50mm/s");
  const double size = ct.spacing[0];
  for (std::size_t n = 0; n < walls.size(); ++n) {
    const auto [first, last] = wayIn(ticks, walls[n] - 8.0 * ways[n], walls[n] + 1.5 * ways[n]);
    const double off = glm::dot(first.hand - walls[n], ways[n]) / size;
    const double depth = glm::length(last.hand - last.proxy);
    std::printf("  wall off %+.2f voxel, %.2f mm deep, %.3f N\n", off, depth,
                glm::length(last.force));
    // A cubic spline deviates a little from the line between the two voxels; a tick is a twentieth
    // of a voxel.
    EXPECT_NEAR(off, 0.0, 0.25);
    EXPECT_NEAR(glm::length(last.force), kStiffness * depth * 1e-3, 1e-5);
    // No deeper than for a straight press; these walls slant by less than 45 degrees.
    EXPECT_LT(depth, 1.5 + 0.25 * size);
    EXPECT_GT(depth, (1.5 - 0.25 * size) * std::sqrt(0.5));
    // The wall that holds the probe is where bone begins: a quarter of a voxel outwards the value
    // is below the threshold, as far inwards it is above.
    const Vec3 out = glm::normalize(last.proxy - last.hand) * 0.25 * size;
    EXPECT_LT(image.interpolate((last.proxy + out) * 1e-3), kThreshold);
    EXPECT_GT(image.interpolate((last.proxy - out) * 1e-3), kThreshold);
  }
}

}  // namespace
}  // namespace palpate::testing
