// palpate import --to: the way that it finds is open in the voxels, and is felt as predicted; if
// there is a way, it finds one.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tools/imported.h"
#include "vdb/made_scans.h"

namespace palpate::testing {
namespace {

using vdb::Image;

constexpr double kSkin = 26.0;   // [mm] radii around the origin
constexpr double kBone = 22.0;   // outer
constexpr double kInner = 19.0;  // of the bone
constexpr double kTarget = 4.0;
constexpr int kBrainLabel = 1, kBoneLabel = 2, kTargetLabel = 3, kVesselLabel = 4, kFatLabel = 5;

/// A head: brain in a skull with a round opening, a target off its center, and a vessel beside the
/// way.
struct Head {
  Vec3 opening{0.0, 0.0, 1.0};  ///< unit, from the origin
  double half_angle = 0.5;      ///< [rad] of the opening; below 0: none
  Vec3 target{0.0};             ///< [mm]
  Vec3 vessel{0.0}, along{1.0, 0.0, 0.0};
  double vessel_radius = 0.0;  ///< [mm] 0: none

  [[nodiscard]] double label(const Vec3& p) const {
    const double r = glm::length(p);
    if (r > kSkin) return 0.0;
    if (glm::length(p - target) < kTarget) return kTargetLabel;
    const Vec3 aside = p - vessel;
    const double off = glm::length(aside - glm::dot(aside, along) * along);
    if (r < kInner && off < vessel_radius) return kVesselLabel;
    if (r < kInner) return kBrainLabel;
    const bool is_open = half_angle >= 0.0 && glm::dot(p, opening) > r * std::cos(half_angle);
    return r < kBone && !is_open ? kBoneLabel : kFatLabel;
  }
};

constexpr const char* kTable = R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: a needle}
stiffest: {value: 2000 N/m, basis: assumed, source: a device}
shaft_spring: {value: 3e4 N/m^2, basis: assumed, source: round}
tissues:
  bone: {labels: [skull], class: rigid, stiffness: {value: 2000 N/m, basis: assumed, source: round}}
  vessel: {labels: [artery], class: membrane, spared: true, stiffness: {value: 500 N/m, basis: assumed, source: round}, opens_at: {value: 1 N, basis: assumed, source: round}}
  fat: {labels: [fat], stiffness: {value: 300 N/m, basis: assumed, source: round}, opens_at: {value: 2 N, basis: assumed, source: round}, cutting: {value: 0.4 N, basis: assumed, source: round}, shaft: {value: 20 N/m, basis: assumed, source: round}}
  brain: {labels: [brain], stiffness: {value: 400 N/m, basis: assumed, source: round}, opens_at: {value: 0.5 N, basis: assumed, source: round}, cutting: {value: 0.2 N, basis: assumed, source: round}, shaft: {value: 10 N/m, basis: assumed, source: round}}
  fluid: {labels: [fluid], class: fluid, viscosity: {value: 0.3 N.s/m, basis: assumed, source: round}}
  deep: {labels: [thalamus], stiffness: {value: 600 N/m, basis: assumed, source: round}, opens_at: {value: 0.7 N, basis: assumed, source: round}, cutting: {value: 0.3 N, basis: assumed, source: round}, shaft: {value: 15 N/m, basis: assumed, source: round}}
)";

Image imageOf(const Head& head) {
  return vdb::test::imageAround(Vec3(0.0), Mat3(1.0), 60.0,
                                [&](const Vec3& p) { return head.label(p); });
}

CommandResult planned(const TempFolder& folder, const Image& image) {
  (void)vdb::test::writeNifti(image, folder, "head.nii.gz");
  (void)folder.file("names.csv", "value,name\n1,brain\n2,skull\n3,thalamus\n4,artery\n5,fat\n");
  (void)folder.file("table.yaml", kTable);
  return runPalpate({"import", "head.nii.gz", "--names", "names.csv", "--materials", "table.yaml",
                     "--to", "thalamus", "-o", "head.yaml", "--force", "--json"},
                    folder.path());
}

int labelAt(const Image& image, const Vec3& mm) {
  const Vec3 index = glm::round(image.toIndex(1e-3 * mm));
  for (int axis = 0; axis < 3; ++axis) {
    if (index[axis] < 0 || index[axis] >= image.size[static_cast<std::size_t>(axis)]) return 0;
  }
  return static_cast<int>(
      image.at(static_cast<int>(index.x), static_cast<int>(index.y), static_cast<int>(index.z)));
}

/// [mm] Length of the way in each label; nothing if it meets bone or the vessel.
std::optional<std::map<int, double>> walked(const Image& image, const Vec3& from, const Vec3& to) {
  constexpr double kStep = 0.05;
  std::map<int, double> lengths;
  const double length = glm::length(to - from);
  const int steps = static_cast<int>(length / kStep);
  for (int n = 0; n <= steps; ++n) {
    const int label = labelAt(image, from + (to - from) * (n / static_cast<double>(steps)));
    if (label == kBoneLabel || label == kVesselLabel) return std::nullopt;
    lengths[label] += length / steps;
  }
  return lengths;
}

/// [mm] Distance from the line to the nearest voxel center of bone or vessel.
double clearanceOf(const Image& image, const Vec3& from, const Vec3& to) {
  double nearest = 1e9;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i) {
        const int label = static_cast<int>(image.at(i, j, k));
        if (label != kBoneLabel && label != kVesselLabel) continue;
        const Vec3 p = 1e3 * image.toWorld(Vec3(i, j, k));
        const double share =
            std::clamp(glm::dot(p - from, to - from) / glm::dot(to - from, to - from), 0.0, 1.0);
        nearest = std::min(nearest, glm::length(p - from - share * (to - from)));
      }
    }
  }
  return nearest;
}

Vec3 pointOf(const Json& meters) {
  return 1e3 * Vec3(meters[0].get<double>(), meters[1].get<double>(), meters[2].get<double>());
}

Head randomHead(std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Head head;
  head.opening = vdb::test::direction(random);
  head.half_angle = share(random) < 0.25 ? -1.0 : 0.1 + 0.6 * share(random);
  head.target = 10.0 * share(random) * vdb::test::direction(random);
  if (share(random) < 0.5) {
    head.along = vdb::test::direction(random);
    // The vessel must not pass through the target.
    const Vec3 aside = glm::normalize(
        glm::cross(head.along, std::abs(head.along.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0)));
    head.vessel = head.target + (kTarget + 3.0 + 4.0 * share(random)) * aside;
    head.vessel_radius = 2.0;
  }
  return head;
}

TEST(ImportWay, IsOpenInTheVoxelsAndRefusedOnlyWhereNoneIs) {
  int found = 0, refused = 0;
  std::mt19937 random(22);
  for (int number = 0; number < 24; ++number) {
    SCOPED_TRACE(number);
    const TempFolder folder;
    const Head head = randomHead(random);
    const Image image = imageOf(head);
    const CommandResult result = planned(folder, image);
    if (result.exit_code != 0) {
      ++refused;
      EXPECT_EQ(result.exit_code, 3);
      EXPECT_NE((result.out + result.err).find("import.way"), std::string::npos) << result.out;
      EXPECT_NE((result.out + result.err).find("'skull' (bone)"), std::string::npos) << result.out;
      EXPECT_FALSE(std::filesystem::exists(folder.path("head.yaml")));
      for (int n = 0; n < 3000; ++n) {
        const Vec3 way = vdb::test::direction(random);
        ASSERT_FALSE(walked(image, head.target + 60.0 * way, head.target)) << n;
      }
      continue;
    }
    ++found;
    const Json way = parseOnly(result)["way"];
    const Vec3 from = pointOf(way["from_m"]);
    const Vec3 to = pointOf(way["to_m"]);
    EXPECT_EQ(labelAt(image, from), 0);
    EXPECT_EQ(labelAt(image, to), kTargetLabel);
    // The deepest voxel of a ball is its middle, within a voxel.
    EXPECT_LT(glm::length(to - head.target), 1.8);
    const auto lengths = walked(image, from, to);
    ASSERT_TRUE(lengths);
    // Voxels are cubes of 1 mm: their corners are 0.87 mm from their centers.
    if (way["clearance_m"] > 0.0) {
      EXPECT_GE(clearanceOf(image, from, to), 2.0 - 0.87);
    }
    std::map<int, double> told;
    const std::map<std::string, int> numbers = {
        {"brain", kBrainLabel}, {"thalamus", kTargetLabel}, {"fat", kFatLabel}};
    for (const Json& part : way["parts"]) {
      told[numbers.at(part["region"])] += 1e3 * part["length_m"].get<double>();
    }
    // The search samples every half voxel.
    for (const auto& [label, length] : told) EXPECT_NEAR(length, lengths->at(label), 1.0) << label;
  }
  EXPECT_GE(found, 8);
  EXPECT_GE(refused, 3);
}

TEST(ImportWay, TheForceIsAsPredicted) {
  const TempFolder folder;
  Head head;
  head.target = Vec3(0.0, 0.0, 4.0);
  const CommandResult result = planned(folder, imageOf(head));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json way = parseOnly(result)["way"];
  // Through the opening: 7 mm of fat, 15 - 4 mm of brain, 4 mm of the target, within voxels.
  ASSERT_EQ(way["parts"].size(), 3U);
  EXPECT_EQ(way["parts"][0]["region"], "fat");
  EXPECT_EQ(way["parts"][1]["region"], "brain");
  EXPECT_EQ(way["parts"][2]["region"], "thalamus");
  const double fat = way["parts"][0]["length_m"];
  const double brain = way["parts"][1]["length_m"];
  const double deep = way["parts"][2]["length_m"];
  EXPECT_NEAR(fat, 7e-3, 1e-3);
  EXPECT_NEAR(brain, 11e-3, 1e-3);
  EXPECT_NEAR(deep, 4e-3, 1e-3);
  EXPECT_EQ(way["parts"][0]["rupture_N"], 2.0);
  EXPECT_NEAR(way["parts"][2]["force_N"], 20.0 * fat + 10.0 * brain + 15.0 * deep + 0.3, 1e-9);
  EXPECT_EQ(way["peak_force_N"], 2.0);  // the skin of this head is its fat

  const std::vector<TracedTick> ticks =
      touched(folder, "head.yaml", {pointOf(way["from_m"]), pointOf(way["to_m"])}, "5mm/s");
  EXPECT_EQ(ticks.back().region, "thalamus");
  double peak = 0.0;
  for (const TracedTick& tick : ticks) peak = std::max(peak, glm::length(tick.force));
  // A wall opens in the tick after its force is reached; 600 N/m give 3 mN for a tick of 5 um.
  EXPECT_NEAR(peak, 2.0, 0.01);
  EXPECT_NEAR(glm::length(ticks.back().force), way["parts"][2]["force_N"], 0.02);
  // The scene's header suggests the same.
  const std::string scene = textOf(folder.path("head.yaml"));
  EXPECT_NE(scene.find("# A probe to thalamus by the shortest way that is open"),
            std::string::npos);
}

TEST(ImportWay, ATargetThatThereIsNotIsNamed) {
  const TempFolder folder;
  (void)planned(folder, imageOf({}));
  const auto to = [&](const std::string& target) {
    return runPalpate({"import", "head.nii.gz", "--names", "names.csv", "--materials", "table.yaml",
                       "--to", target, "--dry-run"},
                      folder.path());
  };
  const CommandResult slip = to("thalmus");
  EXPECT_EQ(slip.exit_code, 3);
  EXPECT_NE(slip.err.find("did you mean `thalamus`"), std::string::npos) << slip.err;
  EXPECT_EQ(to("9").exit_code, 3);
  EXPECT_EQ(to("artery").exit_code, 3) << "the image holds none";
  EXPECT_EQ(to("3").exit_code, 0);
}

/// A file of Slicer's with points in LPS, in mm.
std::string markupsOf(const std::vector<std::pair<std::string, Vec3>>& ras) {
  Json points = Json::array();
  for (const auto& [label, p] : ras) {
    points.push_back({{"label", label}, {"position", {-p.x, -p.y, p.z}}});
  }
  Json list = {{{"type", "Fiducial"}, {"coordinateSystem", "LPS"}, {"controlPoints", points}}};
  return Json{{"markups", list}}.dump();
}

TEST(ImportWay, LeadsToAPointThatWasMarkedInSlicer) {
  const TempFolder folder;
  Head head;
  head.target = Vec3(0.0, 0.0, 4.0);
  (void)planned(folder, imageOf(head));
  const auto to = [&](const std::vector<std::pair<std::string, Vec3>>& points) {
    (void)folder.file("goal.mrk.json", markupsOf(points));
    return runPalpate(
        {"import", "head.nii.gz", "--names", "names.csv", "--materials", "table.yaml", "--to",
         "goal.mrk.json", "-o", "goal.yaml", "--way", "way.mrk.json", "--force", "--json"},
        folder.path());
  };
  // The goal is in the brain, beside the target; the shortest way leads through the opening above.
  const Vec3 goal(3.0, -2.0, 10.0);
  CommandResult result = to({{"P-1", goal}});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  Json way = parseOnly(result)["way"];
  EXPECT_EQ(way["target"], "P-1");
  EXPECT_LT(glm::length(pointOf(way["to_m"]) - goal), 1e-9);
  EXPECT_TRUE(walked(imageOf(head), pointOf(way["from_m"]), goal));
  // A line of Slicer's: from the entry to the target, in LPS.
  const Json line = Json::parse(textOf(folder.path("way.mrk.json")))["markups"][0];
  EXPECT_EQ(line["type"], "Line");
  EXPECT_EQ(line["coordinateSystem"], "LPS");
  ASSERT_EQ(line["controlPoints"].size(), 2U);
  for (const auto& [n, key] : {std::pair{0, "entry_m"}, {1, "to_m"}}) {
    const Json& at = line["controlPoints"][static_cast<std::size_t>(n)]["position"];
    const Vec3 lps = 1e-3 * pointOf(at);
    EXPECT_LT(glm::length(Vec3(-lps.x, -lps.y, lps.z) - pointOf(way[key])), 1e-9) << key;
  }
  // With an entry, the way follows the line from it, whichever of the two points the entry is.
  const Vec3 entry(6.0, 4.0, 30.0);
  for (const auto& points : {std::vector<std::pair<std::string, Vec3>>{{"", entry}, {"", goal}},
                             {{"Target", goal}, {"", entry}},
                             {{"my target", goal}, {"Entry-1", entry}}}) {
    result = to(points);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    way = parseOnly(result)["way"];
    const Vec3 along = glm::normalize(pointOf(way["from_m"]) - goal);
    // Ends are written in tenths of a millimeter.
    EXPECT_GT(glm::dot(along, glm::normalize(entry - goal)), 1.0 - 2e-5);
  }
  const CommandResult closed = to({{"entry", Vec3(30.0, 0.0, 4.0)}, {"target", goal}});
  EXPECT_EQ(closed.exit_code, 3);
  EXPECT_NE(closed.out.find("it meets 'skull' (bone)"), std::string::npos) << closed.out;
}

TEST(ImportWay, ABurrHoleOpensBoneOnTheWayAndNowhereElse) {
  std::mt19937 random(23);
  for (int number = 0; number < 4; ++number) {
    SCOPED_TRACE(number);
    const TempFolder folder;
    Head head = randomHead(random);
    head.half_angle = -1.0;  // closed all around
    const Image image = imageOf(head);
    ASSERT_EQ(planned(folder, image).exit_code, 3);
    const CommandResult result =
        runPalpate({"import", "head.nii.gz", "--names", "names.csv", "--materials", "table.yaml",
                    "--to", "thalamus", "--burr-hole", "12", "-o", "head.yaml", "--json"},
                   folder.path());
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
    const Json way = parseOnly(result)["way"];
    const Vec3 from = pointOf(way["from_m"]);
    const Vec3 to = pointOf(way["to_m"]);
    EXPECT_EQ(way["burr_hole"]["through"], "skull");
    EXPECT_GE(way["clearance_m"].get<double>(), 2e-3);
    EXPECT_LT(glm::length(to - head.target), 1.8);

    // Bone within 6 mm of the way is a label of its own, all else is as it was. The ends of the
    // way are rounded to tenths of a millimeter, so that voxels near the rim may be either.
    const Image drilled = vdb::readImage(folder.path("head.labels.nii.gz"));
    ASSERT_EQ(drilled.size, image.size);
    const Vec3 along = glm::normalize(from - to);
    std::size_t n = 0;
    std::uint64_t opened = 0;
    for (int k = 0; k < image.size[2]; ++k) {
      for (int j = 0; j < image.size[1]; ++j) {
        for (int i = 0; i < image.size[0]; ++i, ++n) {
          const Vec3 d = 1e3 * image.toWorld(Vec3(i, j, k)) - to;
          const double s = glm::dot(d, along);
          const double off = glm::length(d - s * along);
          const bool is_bone = static_cast<int>(image.values[n]) == kBoneLabel;
          if (is_bone && s > 0.0 && std::abs(off - 6.0) < 0.2) {
            opened += drilled.values[n] == image.values[n] ? 0U : 1U;
          } else if (is_bone && s > 0.0 && off < 6.0) {
            ++opened;
            ASSERT_EQ(drilled.values[n], kFatLabel + 1);
          } else {
            ASSERT_EQ(drilled.values[n], image.values[n]);
          }
        }
      }
    }
    EXPECT_EQ(way["burr_hole"]["voxels"].get<std::uint64_t>(), opened);
    EXPECT_TRUE(walked(drilled, from, to));

    // A needle goes through the hole to the target, and 9 mm beside it is stopped by the bone.
    const std::vector<TracedTick> ticks = touched(folder, "head.yaml", {from, to}, "20mm/s");
    EXPECT_EQ(ticks.back().region, "thalamus");
    const Vec3 other = std::abs(along.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
    const Vec3 aside = 9.0 * glm::normalize(glm::cross(along, other));
    for (const TracedTick& tick :
         touched(folder, "head.yaml", {from + aside, to + aside}, "20mm/s")) {
      ASSERT_TRUE(tick.region == "outside" || tick.region == "fat") << tick.region;
    }
  }
}

TEST(ImportWay, ABurrHoleThatIsNotNeededOrNotOneIsRefused) {
  const TempFolder folder;
  (void)planned(folder, imageOf({}));
  const auto asked = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"import",      "head.nii.gz", "--names",  "names.csv",
                                          "--materials", "table.yaml",  "--dry-run"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runPalpate(arguments, folder.path());
  };
  EXPECT_EQ(asked({"--burr-hole", "12"}).exit_code, 2) << "no target";
  EXPECT_EQ(asked({"--to", "thalamus", "--burr-hole", "3"}).exit_code, 2);
  EXPECT_EQ(asked({"--to", "thalamus", "--burr-hole", "wide"}).exit_code, 2);
}

TEST(ImportWay, AFileOfPointsThatIsNoTargetIsRefused) {
  const TempFolder folder;
  (void)planned(folder, imageOf({}));
  const auto refused = [&](const std::string& text) {
    (void)folder.file("goal.mrk.json", text);
    const CommandResult result =
        runPalpate({"import", "head.nii.gz", "--names", "names.csv", "--materials", "table.yaml",
                    "--to", "goal.mrk.json", "--dry-run"},
                   folder.path());
    EXPECT_EQ(result.exit_code, 3) << text;
    return result.err;
  };
  const Vec3 middle(0.0);
  EXPECT_NE(refused(markupsOf({})).find("has 0 points"), std::string::npos);
  EXPECT_NE(refused(markupsOf({{"", middle}, {"", middle}, {"", middle}})).find("has 3 points"),
            std::string::npos);
  EXPECT_NE(refused(markupsOf({{"", middle}, {"", Vec3(0.5, 0, 0)}})).find("less than 1 mm"),
            std::string::npos);
  EXPECT_NE(refused(markupsOf({{"tip", Vec3(29.0, 0, 0)}})).find("'tip' at (29, 0, 0) mm (RAS)"),
            std::string::npos);
  EXPECT_NE(refused("{\n\n \"markups\": [}").find("line 3 is not JSON"), std::string::npos);
  EXPECT_NE(refused("[]").find("the file has no 'markups'"), std::string::npos);
}

}  // namespace
}  // namespace palpate::testing
