// What the page of `palpate view` marks in a scene: gray slices of the scan, ports on the surfaces,
// holes, and the shaft of a needle.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "helpers.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/image.h"
#include "support/wait.h"
#include "view/gray_slices.h"
#include "view/page_desk.h"
#include "view/port_patches.h"
#include "view/recorded_run.h"
#include "view/seen_marks.h"
#include "view/shown_scene.h"

namespace palpate::tools {
namespace {

using testing::TempFolder;

constexpr double kMm = 1e-3;

/// Voxels of 2 x 2 x 4 mm. Values grow along each axis, by a different step for each.
std::shared_ptr<vdb::Image> ramp() {
  auto image = std::make_shared<vdb::Image>();
  image->source = "folder/ramp.nii";
  image->size = {5, 4, 3};
  image->axes = Mat3(Vec3(2 * kMm, 0.0, 0.0), Vec3(0.0, 2 * kMm, 0.0), Vec3(0.0, 0.0, 4 * kMm));
  image->origin = Vec3(10 * kMm, 20 * kMm, 30 * kMm);
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 5; ++i) image->values.push_back(static_cast<float>(i + 10 * j + 50 * k));
    }
  }
  return image;
}

std::uint32_t numberAt(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

int shadeAt(const std::string& slice, std::size_t u, std::size_t v) {
  return static_cast<unsigned char>(slice.at(12 + u + v * numberAt(slice, 4)));
}

const auto kAlways = [] { return true; };

TEST(GraySlices, ShadesAreThoseOfTheVoxelsWhereTheyAre) {
  const auto image = ramp();
  const GraySlices slices(image, Box3{Vec3(-1.0), Vec3(1.0)}, kAlways);
  ASSERT_FALSE(slices.isEmpty());
  const Json json = slices.json();
  EXPECT_EQ(json["file"], "ramp.nii");
  // Slices are 2 mm apart, also along z, where voxels are 4 mm apart: 5 slices for 3 voxels.
  EXPECT_EQ(json["counts"], Json::array({5, 4, 5}));
  EXPECT_NEAR(json["box"]["lo"][0].get<double>(), 9 * kMm, 1e-12);
  EXPECT_NEAR(json["box"]["hi"][2].get<double>(), 39 * kMm, 1e-12);
  // Shades run from the 1st to the 99th percentile: of 60 voxels, the lowest and the highest.
  const double highest = 4 + 10 * 3 + 50 * 2;
  const auto shade = [&](double value) {
    return 1 + static_cast<int>(std::lround(254.0 * value / highest));
  };
  const auto across_x = slices.slice(0, 3);
  const auto across_y = slices.slice(1, 2);
  const auto across_z = slices.slice(2, 4);
  ASSERT_TRUE(across_x && across_y && across_z);
  EXPECT_EQ(across_x->substr(0, 4), "PSLC");
  EXPECT_EQ(numberAt(*across_x, 4), 4U);
  EXPECT_EQ(numberAt(*across_x, 8), 5U);
  EXPECT_EQ(across_x->size(), 12U + 4 * 5);
  EXPECT_EQ(numberAt(*across_y, 4), 5U);
  EXPECT_EQ(numberAt(*across_z, 8), 4U);
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double value = 3.0 + 10.0 * static_cast<double>(j) + 50.0 * static_cast<double>(k);
      EXPECT_EQ(shadeAt(*across_x, j, 2 * k), shade(value)) << j << " " << k;
    }
  }
  EXPECT_EQ(shadeAt(*across_y, 1, 2), shade(1 + 20 + 50));
  EXPECT_EQ(shadeAt(*across_z, 4, 3), shade(highest));
  // This slice is half way between two layers of voxels.
  EXPECT_EQ(shadeAt(*slices.slice(2, 1), 2, 1), shade(2 + 10 + 25));
}

TEST(GraySlices, WhatIsNotThereIsNotAnswered) {
  const GraySlices slices(ramp(), Box3{Vec3(-1.0), Vec3(1.0)}, kAlways);
  EXPECT_TRUE(slices.slice(0, 4));
  EXPECT_FALSE(slices.slice(0, 5));
  EXPECT_FALSE(slices.slice(1, 4));
  EXPECT_FALSE(slices.slice(3, 0));
  auto holey = ramp();
  holey->values[0] = std::numeric_limits<float>::quiet_NaN();
  const GraySlices with_hole(holey, Box3{Vec3(-1.0), Vec3(1.0)}, kAlways);
  EXPECT_EQ(shadeAt(*with_hole.slice(0, 0), 0, 0), 0);
  EXPECT_GT(shadeAt(*with_hole.slice(0, 1), 0, 0), 0);
  auto even = ramp();
  even->values.assign(even->values.size(), 7.0F);
  EXPECT_TRUE(GraySlices(even, Box3{Vec3(-1.0), Vec3(1.0)}, kAlways).isEmpty());
  // A view that does not reach the scan.
  const GraySlices elsewhere(ramp(), Box3{Vec3(-1.0), Vec3(-0.5)}, kAlways);
  EXPECT_TRUE(elsewhere.isEmpty());
  EXPECT_FALSE(elsewhere.slice(0, 0));
}

TEST(GraySlices, AreNoLargerThanTheyMayBeWhateverTheScan) {
  auto image = std::make_shared<vdb::Image>();
  image->size = {1200, 300, 2};
  image->axes = Mat3(1e-4);
  for (std::size_t i = 0; i < 720'000; ++i) image->values.push_back(static_cast<float>(i % 1200));
  const GraySlices slices(image, Box3{Vec3(-1.0), Vec3(1.0)}, kAlways);
  EXPECT_EQ(slices.json()["counts"], Json::array({GraySlices::kLongest, 64, 1}));
  // Only the viewed part is kept, as fine as the voxels.
  const GraySlices part(image, Box3{Vec3(0.0), Vec3(0.01)}, kAlways);
  EXPECT_EQ(part.json()["counts"], Json::array({100, 100, 2}));
  // If the caller gives up at once, hardly anything is computed.
  int asked = 0;
  const GraySlices given_up(image, Box3{Vec3(-1.0), Vec3(1.0)}, [&] { return ++asked < 1; });
  EXPECT_TRUE(given_up.isEmpty());
}

double areaOf(const SurfaceNet& net) {
  double area = 0.0;
  for (const auto& t : net.triangles) {
    area += 0.5 * glm::length(glm::cross(net.points[t[1]] - net.points[t[0]],
                                         net.points[t[2]] - net.points[t[0]]));
  }
  return area;
}

/// The patches of a scene, on surfaces made with `cells` cells along the longest side.
std::vector<SurfaceNet> patchesOf(const std::string& text, int cells) {
  const ScenePtr scene = compile(parseScene(text, "scene.yaml"));
  PortPatches patches(scene, glm::length(viewBox(*scene).size()));
  for (std::size_t i = 1; i < scene->regions().size(); ++i) {
    const FieldPtr& field = scene->regions()[i].field;
    patches.add(static_cast<RegionId>(i), surfaceNet(*field, viewBox(*scene), cells), kAlways);
  }
  return patches.patches();
}

TEST(PortPatches, AMouthIsTheDiscOfItsBrim) {
  const int cells = 48;
  const std::vector<SurfaceNet> patches = patchesOf(testing::kContainer, cells);
  ASSERT_EQ(patches.size(), 1U);
  const SurfaceNet& mouth = patches[0];
  const double radius = std::sqrt(40.0 * 40.0 - 15.0 * 15.0) * kMm;
  const double cell = 1.12 * 80.0 * kMm / cells;
  // The mouth's rim is an edge, which the net rounds off by up to a cell.
  const double rim = 2.0 * std::numbers::pi * radius * cell;
  EXPECT_NEAR(areaOf(mouth), std::numbers::pi * radius * radius, rim);
  for (const Vec3& p : mouth.points) {
    EXPECT_NEAR(p.z, 15.0 * kMm, cell);
    EXPECT_LT(std::hypot(p.x, p.y), radius + cell);
  }
}

constexpr const char* kBallInBall = R"(
palpate: 1
length: mm
fields:
  small: {sphere: {center: [0, 0, 40], radius: RADIUS}}
layers:
  - {name: ball, inside: {sphere: {center: [0, 0, 0], radius: 40}}}
  - {name: core, inside: {sphere: {center: [0, 0, 0], radius: 20}}}
ports:
  - {name: hole, between: [outside, ball], where: small}
  - {name: skin, between: [ball, core], opens_at: 2 N}
)";

std::string ballInBall(const std::string& radius) {
  std::string text = kBallInBall;
  text.replace(text.find("RADIUS"), 6, radius);
  return text;
}

TEST(PortPatches, ARimIsAsRoundAsASixteenthOfATriangle) {
  const int cells = 40;
  const std::vector<SurfaceNet> patches = patchesOf(ballInBall("16"), cells);
  // A ball around a point of a larger ball's surface cuts a cap from it; the cap has the area of a
  // disc of the smaller ball's radius.
  const double radius = 16.0 * kMm;
  const double side = std::sqrt(2.0) * 1.12 * 80.0 * kMm / cells / 16.0;
  EXPECT_NEAR(areaOf(patches[0]), std::numbers::pi * radius * radius,
              2.0 * std::numbers::pi * radius * side);
  for (const Vec3& p : patches[0].points) {
    EXPECT_LT(glm::distance(p, Vec3(0.0, 0.0, 40.0 * kMm)), radius + side);
  }
}

TEST(PortPatches, APortThatOpensByForceIsAllOfItsWall) {
  const int cells = 40;
  const std::vector<SurfaceNet> patches = patchesOf(ballInBall("16"), cells);
  const FieldPtr core = sphere(Vec3(0.0), 20.0 * kMm);
  const ScenePtr scene = compile(parseScene(ballInBall("16"), "scene.yaml"));
  const SurfaceNet whole = surfaceNet(*core, viewBox(*scene), cells);
  EXPECT_EQ(patches[1].triangles.size(), whole.triangles.size());
  EXPECT_NEAR(areaOf(patches[1]), areaOf(whole), 1e-12);
}

TEST(PortPatches, APortWithinOneTriangleIsFound) {
  const int cells = 10;  // of 9 mm
  const std::vector<SurfaceNet> patches = patchesOf(ballInBall("0.8"), cells);
  const double area = std::numbers::pi * 0.8 * 0.8 * kMm * kMm;
  // The port is found in triangles no wider than itself, so its rim is off by a 16th of a triangle.
  EXPECT_NEAR(areaOf(patches[0]), area, 2.0 * std::numbers::pi * 0.8 * 0.8 / 16.0 * kMm * kMm);
}

/// A membrane that keeps holes, and tissue behind it that holds a needle.
constexpr const char* kTissue = R"(
palpate: 1
length: mm
materials:
  skin: {stiffness: 300 N/m}
  flesh: {stiffness: 300 N/m, cutting: 0.2 N}
layers:
  - {name: fat, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}
  - {name: muscle, inside: {half_space: {point: [0, 0, -10], normal: [0, 0, 1]}}, wall: flesh, content: flesh}
ports:
  - {name: puncture, between: [outside, fat], opens_at: 1 N, back: 0.1 N, hole: {radius: 1, reopens_at: 0.1 N}}
  - {name: fascia, between: [fat, muscle], opens_at: 1 N, back: 0.1 N}
)";

RegionEntry entry(RegionId from, RegionId to, int port, const Vec3& point, double radius) {
  return {.from = from,
          .to = to,
          .port = port,
          .point = point,
          .normal = Vec3(0.0, 0.0, from < to ? 1.0 : -1.0),
          .force = 1.0,
          .hole_radius = radius};
}

TEST(SeenMarks, HolesStayUntilAllIsForgottenAndTheShaftWhileItIsHeld) {
  const ScenePtr scene = compile(parseScene(kTissue, "scene.yaml"));
  SeenMarks marks(*scene);
  const Vec3 skin(0.0, 0.0, 0.0);
  const Vec3 fascia(0.0, 0.0, -10.0 * kMm);
  marks.add(entry(0, 1, 0, skin, kMm));
  ASSERT_EQ(marks.holes().size(), 1U);
  EXPECT_EQ(marks.holes()[0].point, skin);
  EXPECT_EQ(marks.holes()[0].radius, kMm);
  EXPECT_FALSE(marks.fulcrum());  // fat holds nothing
  marks.add(entry(1, 2, 1, fascia, 0.0));
  EXPECT_EQ(marks.holes().size(), 1U);  // this port leaves none
  ASSERT_TRUE(marks.fulcrum());
  EXPECT_EQ(*marks.fulcrum(), fascia);
  marks.add(entry(2, 1, 1, fascia, 0.0));
  EXPECT_FALSE(marks.fulcrum());
  // Out, then in once more through the same hole, and through another hole beside it.
  marks.add(entry(1, 0, 0, skin, kMm));
  EXPECT_TRUE(marks.holes().empty());  // outside forgets
  marks.add(entry(0, 1, 0, skin, kMm));
  marks.add(entry(0, 1, 0, skin + Vec3(0.5 * kMm, 0.0, 0.0), kMm));
  marks.add(entry(0, 1, 0, skin + Vec3(3.0 * kMm, 0.0, 0.0), kMm));
  EXPECT_EQ(marks.holes().size(), 2U);
}

TEST(SeenMarks, ANeedleThatComesOutOnTheOtherSideIsHeldByBoth) {
  const ScenePtr scene = compile(parseScene(kTissue, "scene.yaml"));
  SeenMarks marks(*scene);
  marks.add(entry(1, 2, 1, Vec3(0.0), 0.0));
  RegionEntry out = entry(2, 1, 1, Vec3(0.0, 0.0, -30.0 * kMm), 0.0);
  out.normal = Vec3(0.0, 0.0, 1.0);
  marks.add(out);
  ASSERT_TRUE(marks.fulcrum());
  EXPECT_EQ(*marks.fulcrum(), Vec3(0.0));
  // The needle goes back into the muscle, and out where it came in.
  RegionEntry back = entry(1, 2, 1, Vec3(0.0, 0.0, -30.0 * kMm), 0.0);
  back.normal = Vec3(0.0, 0.0, -1.0);
  marks.add(back);
  marks.add(entry(2, 1, 1, Vec3(0.0), 0.0));
  EXPECT_FALSE(marks.fulcrum());
}

TEST(SeenMarks, GoOnInAnEditedSceneByTheNamesOfPortsAndRegions) {
  const ScenePtr scene = compile(parseScene(kTissue, "scene.yaml"));
  SeenMarks marks(*scene);
  marks.add(entry(0, 1, 0, Vec3(0.0), kMm));
  marks.add(entry(1, 2, 1, Vec3(0.0, 0.0, -10.0 * kMm), 0.0));
  const auto edited = [](std::string text, const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
    return compile(parseScene(text, "scene.yaml"));
  };
  // A new port before the others raises their numbers by one.
  const ScenePtr shifted = edited(
      kTissue, "ports:\n", "ports:\n  - {name: first, between: [fat, muscle], opens_at: 9 N}\n");
  const SeenMarks moved(marks, *scene, *shifted);
  ASSERT_EQ(moved.holes().size(), 1U);
  EXPECT_EQ(moved.holes()[0].port, 1);
  EXPECT_EQ(moved.holes()[0].point, Vec3(0.0));
  ASSERT_TRUE(moved.fulcrum());
  // A port or a layer that is renamed counts as another one.
  const SeenMarks other(marks, *scene, *edited(kTissue, "puncture", "hole"));
  EXPECT_TRUE(other.holes().empty());
  EXPECT_TRUE(other.fulcrum());
  const SeenMarks gone(marks, *scene, *edited(kTissue, "muscle", "liver"));
  EXPECT_EQ(gone.holes().size(), 1U);
  EXPECT_FALSE(gone.fulcrum());
}

TEST(SeenMarks, NoMoreHolesThanTheLoopRemembers) {
  const ScenePtr scene = compile(parseScene(kTissue, "scene.yaml"));
  SeenMarks marks(*scene);
  for (int i = 0; i < 100; ++i) marks.add(entry(0, 1, 0, Vec3(i * 0.01, 0.0, 0.0), kMm));
  EXPECT_EQ(marks.holes().size(), Punctures::kMaxHoles);
  EXPECT_EQ(marks.holes().back().point.x, 0.99);
}

/// A page that shows a record gets the same marks of a needle, tick by tick, as during the touch.
TEST(ViewedMarks, ARecordShowsTheHoleAndTheShaft) {
  const TempFolder folder;
  (void)folder.file("tissue.yaml", kTissue);
  const auto touched = testing::runPalpate(
      {"touch", "tissue.yaml", "--insert", "0,0,10", "0,0,-20", "--record", "felt.npy", "--json"},
      folder.path());
  ASSERT_EQ(touched.exit_code, 0) << touched.err;
  Console console{true};
  LoadedScene loaded(folder.path("tissue.yaml"), console);
  const ScenePtr scene = loaded.compile();
  const RecordedRun run(folder.path("felt.npy"), *scene);
  const FeedView begin = run.at(0, 0);
  EXPECT_TRUE(begin.holes.empty());
  EXPECT_FALSE(begin.fulcrum);
  const FeedView end = run.at(run.size() - 1, 0);
  ASSERT_EQ(end.result.region, 2);
  ASSERT_EQ(end.holes.size(), 1U);
  // In the tick before, the proxy rested on the wall.
  EXPECT_NEAR(end.holes[0].point.z, 0.0, 1e-9);
  EXPECT_EQ(end.holes[0].normal, Vec3(0.0, 0.0, 1.0));
  EXPECT_EQ(end.holes[0].radius, kMm);
  ASSERT_TRUE(end.fulcrum);
  EXPECT_NEAR(end.fulcrum->z, -10.0 * kMm, 1e-9);

  PageDesk desk({.run = &run}, std::make_shared<const ShownScene>(scene, loaded, "", 0));
  const PageHost host = desk.host();
  host.command(R"({"row":)" + std::to_string(run.size() - 1) + "}");
  std::uint64_t seen = 0;
  const Json tick = Json::parse(host.snapshot(seen, {}))["tick"];
  EXPECT_EQ(tick["holes"].size(), 1U);
  EXPECT_EQ(tick["holes"][0]["radius"], kMm);
  EXPECT_NEAR(tick["shaft"][2].get<double>(), -10.0 * kMm, 1e-9);
}

TEST(ViewedMarks, APageGetsPortsAndSlicesOfItsScene) {
  const TempFolder folder;
  (void)folder.file("ramp.nii", vdb::encodeNifti(*ramp(), false));
  (void)folder.file("scene.yaml", R"(palpate: 1
length: mm
images: {scan: {file: ramp.nii}}
fields:
  lid: {half_space: {point: [0, 0, 34], normal: [0, 0, 1]}}
layers:
  - {name: box, inside: {intersection: [{box: {center: [14, 23, 34], size: [4, 4, 8]}}, lid]}}
ports:
  - {name: mouth, between: [outside, box], on: lid}
)");
  Console console{true};
  LoadedScene loaded(folder.path("scene.yaml"), console);
  const ScenePtr scene = loaded.compile();
  const auto shown = std::make_shared<const ShownScene>(scene, loaded, "", 3);
  LiveFeed feed(scene);
  PageDesk desk({.feed = &feed}, shown);
  const PageHost host = desk.host();
  ASSERT_TRUE(testing::waitUntil([&] { return shown->slices() != nullptr; }));
  std::uint64_t seen = 0;
  const Json snapshot = Json::parse(host.snapshot(seen, {}));
  EXPECT_EQ(snapshot["ports"], true);
  EXPECT_EQ(snapshot["slices"], true);
  const auto port = host.get("port/3/0");
  ASSERT_TRUE(port);
  EXPECT_EQ(port->bytes->substr(0, 4), "PSRF");
  const auto words = host.get("slices/3");
  ASSERT_TRUE(words);
  EXPECT_EQ(Json::parse(*words->bytes), shown->slices()->json());
  const auto slice = host.get("slice/3/2/0");
  ASSERT_TRUE(slice);
  EXPECT_EQ(*slice->bytes, *shown->slices()->slice(2, 0));
  for (const char* none : {"port/3/1", "port/2/0", "port/3/", "port/3/0/0", "slices/2", "slices/3/",
                           "slices/", "slice/3/3/0", "slice/3/0/999", "slice/3/0/-1", "slice/3/0",
                           "slice/2/0/0", "slice/3/0/0/0", "ports/3/0", "/", ""}) {
    EXPECT_FALSE(host.get(none)) << none;
  }
}

TEST(ViewedMarks, AMaterialIsNamedWithItsValueAtTheProxy) {
  const TempFolder folder;
  (void)folder.file("ramp.nii", vdb::encodeNifti(*ramp(), false));
  (void)folder.file("scene.yaml", R"(palpate: 1
length: mm
images: {scan: {file: ramp.nii}}
materials:
  bone: {stiffness: {image: scan, transfer: [[0, 500 N/m], [134, 1840 N/m]]}}
layers:
  - {name: slab, inside: {half_space: {point: [0, 0, 32], normal: [0, 0, 1]}}, wall: bone}
)");
  Console console{true};
  LoadedScene loaded(folder.path("scene.yaml"), console);
  const ScenePtr scene = loaded.compile();
  TickResult result;
  result.contact = true;
  result.proxy = Vec3(12 * kMm, 22 * kMm, 32 * kMm);
  const Vec3 hip = result.proxy - Vec3(0.0, 0.0, kMm);
  const Parameter& stiffness = scene->materials()[0].stiffness;
  ASSERT_FALSE(stiffness.isConstant());
  EXPECT_EQ(feltAt(*scene, hip, result).wall,
            "bone (" + formatNumber(stiffness.at(result.proxy)) + " N/m)");
}

TEST(ViewedMarks, TheWallThatIsPressedIsTheFirstBeforeADeepHand) {
  const ScenePtr scene = compile(parseScene(kTissue, "scene.yaml"));
  TickResult result;
  result.contact = true;
  for (const double depth : {0.1, 5.0, 30.0}) {
    // At 30 mm the hand is in the muscle, but the proxy has not met the muscle's wall yet.
    const FeltWords felt = feltAt(*scene, Vec3(0.0, 0.0, -depth * kMm), result);
    EXPECT_EQ(felt.wall, "skin (300 N/m)") << depth;
  }
}

}  // namespace
}  // namespace palpate::tools
