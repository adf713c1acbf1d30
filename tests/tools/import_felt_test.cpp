// palpate import: how tissues of each class feel in a scene that was made from labels.

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "tools/imported.h"
#include "vdb/made_scans.h"

namespace palpate::testing {
namespace {

/// A head of shells about the origin, `numbers[n]` from the outside in: scalp, skull with a burr
/// hole around +z, dura, CSF, white matter, ventricle. [mm]
constexpr std::array<double, 6> kRadii = {22.0, 20.0, 17.0, 15.5, 13.0, 6.0};
constexpr double kHole = 6.0;

void writeHead(const TempFolder& folder, const std::array<int, 6>& numbers) {
  const vdb::Image labels = vdb::test::imageAround(Vec3(0.0), Mat3(1.0), 48.0, [&](const Vec3& mm) {
    const double r = glm::length(mm);
    int layer = -1;
    for (std::size_t n = 0; n < kRadii.size(); ++n)
      layer = r < kRadii.at(n) ? static_cast<int>(n) : layer;
    // Scalp fills the hole.
    if (layer == 1 && mm.z > 0.0 && std::hypot(mm.x, mm.y) < kHole) layer = 0;
    return layer < 0 ? 0 : numbers.at(static_cast<std::size_t>(layer));
  });
  (void)vdb::test::writeNifti(labels, folder, "head.nii.gz");
  constexpr std::array<const char*, 6> kNames = {"scalp", "skull",        "dura mater",
                                                 "CSF",   "white matter", "lateral ventricle"};
  std::string names = "value,name\n";
  for (std::size_t n = 0; n < 6; ++n) {
    names += std::to_string(numbers.at(n)) + "," + kNames.at(n) + "\n";
  }
  (void)folder.file("names.csv", names);
}

TEST(ImportFelt, AVentricleIsEnteredFromWhiteMatterWithoutSlidingAlongIt) {
  const TempFolder folder;
  writeHead(folder, {5, 2, 3, 6, 1, 4});
  (void)run(folder, {"import", "head.nii.gz", "--names", "names.csv", "-o", "head.yaml", "--json"});
  // Down the hole, off its middle: the needle meets the ventricle's wall at 30 degrees to its
  // normal, and leaves it on the far side.
  constexpr double kOff = 3.0;
  const std::vector<TracedTick> ticks =
      touched(folder, "head.yaml", {Vec3(kOff, 0, 30), Vec3(kOff, 0, -9)}, "10mm/s");
  std::vector<std::string> order;
  double farthest = 0.0;
  const TracedTick* before = nullptr;
  double into = 0.0, out_of = 0.0;
  for (const TracedTick& tick : ticks) {
    if (order.empty() || order.back() != tick.region) order.push_back(tick.region);
    const bool is_brain = tick.region == "white matter" || tick.region == "lateral ventricle";
    if (is_brain) farthest = std::max(farthest, std::abs(tick.proxy.x - kOff));
    if (before != nullptr && before->region != tick.region) {
      const double wall = glm::length(before->hand - before->proxy);
      if (tick.region == "lateral ventricle") into = wall;
      if (before->region == "lateral ventricle") out_of = wall;
    }
    before = &tick;
  }
  // The scalp opens 7 mm deep, and the dura behind it in the same tick.
  ASSERT_GE(order.size(), 4U);
  order.erase(order.begin(), order.end() - 4);
  EXPECT_EQ(order,
            (std::vector<std::string>{"CSF", "white matter", "lateral ventricle", "white matter"}));
  // The ependyma opens at 0.05 N in both directions; with 80 N/m that is 0.63 mm across it, and
  // 0.72 mm along the needle at 30 degrees; plus a tick of 0.01 mm.
  std::printf("  ventricle: pressed %.3f mm in, %.3f mm out, %.3f mm aside\n", into, out_of,
              farthest);
  EXPECT_NEAR(into, 0.05 / 80.0 * 1e3, 0.12);
  EXPECT_NEAR(out_of, 0.05 / 80.0 * 1e3, 0.12);
  // It slides no farther than it is pressed in.
  EXPECT_LT(farthest, 0.75);
}

TEST(ImportFelt, CerebrospinalFluidIsDragAndNothingElse) {
  const TempFolder folder;
  (void)vdb::test::writeNifti(
      vdb::test::imageAround(Vec3(0.0), Mat3(1.0), 30.0,
                             [](const Vec3& mm) { return glm::length(mm) < 9.0 ? 1 : 0; }),
      folder, "csf.nii.gz");
  (void)folder.file("names.csv", "value,name\n1,CSF\n");
  (void)run(folder, {"import", "csf.nii.gz", "--names", "names.csv", "-o", "csf.yaml", "--json"});
  constexpr double kSpeed = 0.02;  // [m/s]
  double most = 0.0;
  std::set<std::string> met;
  for (const TracedTick& tick :
       touched(folder, "csf.yaml", {Vec3(2, 0, 14), Vec3(2, 0, -14)}, "20mm/s")) {
    met.insert(tick.region);
    most = std::max(most, glm::length(tick.force));
    EXPECT_LT(glm::length(tick.hand - tick.proxy), 1e-6);
  }
  EXPECT_EQ(met, (std::set<std::string>{"outside", "CSF"}));
  // 0.2 N.s/m; a trace has nine digits.
  EXPECT_NEAR(most, 0.2 * kSpeed, 1e-6);
}

TEST(ImportFelt, NoWayLeadsIntoBone) {
  const TempFolder folder;
  std::mt19937 random(7);
  std::array<int, 6> numbers = {1, 2, 3, 4, 5, 6};
  std::shuffle(numbers.begin(), numbers.end(), random);
  writeHead(folder, numbers);
  (void)run(folder, {"import", "head.nii.gz", "--names", "names.csv", "-o", "head.yaml", "--json"});
  // The path leads into the hole and out through the inner side of the skull in all directions, as
  // deep as a hand can reach.
  std::vector<Vec3> points;
  for (int n = 0; n < 12; ++n) {
    Vec3 way = vdb::test::direction(random);
    way.z = -std::abs(way.z);
    points.insert(points.end(), {Vec3(0, 0, 30), Vec3(0, 0, 10), 30.0 * way, Vec3(0, 0, 10),
                                 Vec3(0, 0, 30), Vec3(0, 30, 5), Vec3(0, 12, 3), Vec3(0, 30, 5)});
  }
  std::set<std::string> met;
  for (const TracedTick& tick : touched(folder, "head.yaml", points, "100mm/s"))
    met.insert(tick.region);
  EXPECT_EQ(met.count("skull"), 0U);
  EXPECT_EQ(met.count("lateral ventricle"), 1U);
  EXPECT_EQ(met.count("outside"), 1U);
}

TEST(ImportFelt, AnAirwayIsFeltAsAMembraneAndThenAsNothing) {
  const TempFolder folder;
  // A block of muscle with a windpipe in it, open at the top.
  (void)vdb::test::writeNifti(
      vdb::test::imageAround(Vec3(0.0), Mat3(1.0), 40.0,
                             [](const Vec3& mm) {
                               const bool is_in = std::abs(mm.x) < 15 && std::abs(mm.y) < 15 &&
                                                  std::abs(mm.z) < 15;
                               return !is_in ? 0 : std::hypot(mm.x, mm.y) < 7 ? 1 : 2;
                             }),
      folder, "neck.nii.gz");
  (void)folder.file("names.csv", "value,name\n1,trachea\n2,muscle\n");
  (void)run(folder, {"import", "neck.nii.gz", "--names", "names.csv", "-o", "neck.yaml", "--json"});
  // From above nothing stands in the way.
  for (const TracedTick& tick :
       touched(folder, "neck.yaml", {Vec3(0, 0, 25), Vec3(0, 0, -10)}, "20mm/s")) {
    EXPECT_EQ(glm::length(tick.force), 0.0);
  }
  // From the side: into the muscle at its 1.5 N, and out of it at the mucosa's 0.2 N.
  const std::vector<TracedTick> ticks =
      touched(folder, "neck.yaml", {Vec3(0, 25, 0), Vec3(0, 0, 0)}, "10mm/s");
  ASSERT_EQ(ticks.back().region, "trachea");
  double pressed = 0.0;
  for (const TracedTick& tick : ticks) {
    if (tick.region == "muscle") pressed = glm::length(tick.hand - tick.proxy);
  }
  EXPECT_NEAR(pressed, 0.2 / 80.0 * 1e3, 0.1);
  EXPECT_LT(glm::length(ticks.back().hand - ticks.back().proxy), 1e-9);
}

}  // namespace
}  // namespace palpate::testing
