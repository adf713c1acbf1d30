// palpate convert: grids, scenes and meshes to meshes, images and grids.

#include <cmath>
#include <filesystem>
#include <numbers>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

constexpr const char* kBall = R"(
palpate: 1
length: mm
layers:
  - {name: ball, inside: {sphere: {center: [3, -20, 40], radius: 15}}}
)";
const double kVolume = 4.0 / 3.0 * std::numbers::pi * std::pow(0.015, 3.0);  // [m^3]

/// The output of `info` for a file.
Json described(const TempFolder& folder, const std::string& name, const std::string& units = "mm") {
  const CommandResult result =
      runPalpate({"info", name, "--units", units, "--json"}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  return parseOnly(result)["files"][0];
}

TEST(Convert, ASceneBecomesAMeshOfEveryFormat) {
  const TempFolder folder;
  (void)folder.file("ball.yaml", kBall);
  for (const std::string extension : {"stl", "obj", "ply", "glb"}) {
    SCOPED_TRACE(extension);
    const std::string name = "ball." + extension;
    const Json json = converted(folder, {"ball.yaml", "-o", name, "--voxel", "1"});
    EXPECT_EQ(json["schema"], "palpate.convert/1");
    EXPECT_EQ(json["unit"], extension == "glb" ? "m" : "mm");
    EXPECT_TRUE(json["closed"]);
    // Triangles of a ball of 15 voxels are some 1e-3 of its radius below its surface.
    EXPECT_NEAR(json["volume_m3"], kVolume, 0.01 * kVolume);
    const Json info = described(folder, name, json["unit"]);
    EXPECT_EQ(info["triangles"], json["triangles"]);
    EXPECT_NEAR(info["volume_m3"], json["volume_m3"], 1e-6 * kVolume);
  }
}

TEST(Convert, AGridBecomesAMeshAndAnImage) {
  const TempFolder folder;
  (void)folder.file("ball.yaml", kBall);
  (void)converted(folder, {"ball.yaml", "-o", "ball.vdb", "--voxel", "1"});
  for (const std::string layer : {"", "ball", "ball/surface"}) {
    std::vector<std::string> arguments{"ball.vdb", "-o",
                                       "from" + std::to_string(layer.size()) + ".ply"};
    if (!layer.empty()) arguments.insert(arguments.end(), {"--layer", layer});
    EXPECT_NEAR(converted(folder, arguments)["volume_m3"], kVolume, 0.01 * kVolume) << layer;
  }
  const Json image = converted(folder, {"ball.vdb", "-o", "ball.nii.gz"});
  EXPECT_EQ(image["kind"], "image");
  const CommandResult query =
      runPalpate({"query", "ball.nii.gz", "--at", "3,-20,56", "--json"}, folder.path());
  ASSERT_EQ(query.exit_code, 0) << query.err << query.out;
  EXPECT_NEAR(parseOnly(query)["points"][0]["value"], 1.0, 0.01);  // [mm] outside
}

TEST(Convert, UnitsOfMeshes) {
  const TempFolder folder;
  (void)folder.file("ball.yaml", kBall);
  (void)converted(folder, {"ball.yaml", "-o", "ball.obj", "--voxel", "1"});
  const Json inches = converted(folder, {"ball.obj", "-o", "inches.stl", "--to-units", "in"});
  EXPECT_EQ(inches["unit"], "in");
  EXPECT_NEAR(described(folder, "inches.stl", "in")["volume_m3"], kVolume, 0.01 * kVolume);
  const Json meters = converted(folder, {"inches.stl", "--units", "in", "-o", "meters.glb"});
  EXPECT_EQ(meters["unit"], "m");
  EXPECT_NEAR(meters["volume_m3"], kVolume, 0.01 * kVolume);
  const Json back =
      converted(folder, {"meters.glb", "--units", "m", "-o", "b.vdb", "--voxel", "1mm"});
  EXPECT_EQ(back["schema"], "palpate.bake/1");
}

TEST(Convert, GltfIsMetersAsItsStandardSays) {
  const TempFolder folder;
  (void)folder.file("ball.yaml", kBall);
  (void)converted(folder, {"ball.yaml", "-o", "ball.glb", "--voxel", "1"});
  // A file that the command wrote comes back in its own size without an option, as a grid and as
  // another mesh.
  const CommandResult back =
      runPalpate({"convert", "ball.glb", "-o", "back.stl", "--json"}, folder.path());
  ASSERT_EQ(back.exit_code, 0) << back.err;
  EXPECT_NEAR(parseOnly(back)["volume_m3"], kVolume, 0.01 * kVolume);
  EXPECT_EQ(parseOnly(back)["unit"], "mm");
  EXPECT_EQ(back.err.find("taken as 1 mm"), std::string::npos) << back.err;
  EXPECT_NEAR(described(folder, "back.stl", "mm")["volume_m3"], kVolume, 0.01 * kVolume);
  (void)converted(folder, {"ball.glb", "-o", "back.vdb", "--voxel", "1mm"});
  (void)folder.file("scene.yaml",
                    "palpate: 1\nlength: mm\nfields: {b: {mesh: {file: ball.glb}}, "
                    "g: {grid: {file: back.vdb}}}\nlayers: [{name: b, inside: b}, "
                    "{name: g, inside: g}]\n");
  const CommandResult query =
      runPalpate({"query", "scene.yaml", "--at", "0,0,0", "--json"}, folder.path());
  ASSERT_EQ(query.exit_code, 0) << query.err;
  // --units overrides that: a file in millimeters is not a proper glTF.
  const Json said = converted(folder, {"ball.glb", "--units", "mm", "-o", "small.stl"});
  EXPECT_NEAR(said["volume_m3"], 1e-9 * kVolume, 1e-11 * kVolume);
}

TEST(Convert, AnImageOfDistancesBecomesTheGridItWas) {
  const TempFolder folder;
  (void)folder.file("ball.yaml", kBall);
  (void)converted(folder, {"ball.yaml", "-o", "ball.nii.gz", "--voxel", "1"});
  const CommandResult back = runPalpate(
      {"convert", "ball.nii.gz", "--distances", "-o", "back.stl", "--json"}, folder.path());
  ASSERT_EQ(back.exit_code, 0) << back.err;
  EXPECT_NEAR(parseOnly(back)["volume_m3"], kVolume, 0.005 * kVolume);
  // --above 0 takes the outside, and a note says so.
  const CommandResult above = runPalpate(
      {"convert", "ball.nii.gz", "--above", "0", "-o", "outside.stl", "--json"}, folder.path());
  EXPECT_NE(above.err.find("--distances takes the inside"), std::string::npos) << above.err;
  const CommandResult both = runPalpate(
      {"convert", "ball.nii.gz", "--above", "0", "--distances", "-o", "x.stl"}, folder.path());
  EXPECT_EQ(both.exit_code, 2) << both.err;
}

TEST(Convert, ATinyVoxelIsAClearError) {
  const TempFolder folder;
  (void)folder.file("ball.yaml", kBall);
  const CommandResult result =
      runPalpate({"convert", "ball.yaml", "-o", "a.vdb", "--voxel", "5e-8"}, folder.path());
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_EQ(result.err.find("unexpected"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("5e-08 mm"), std::string::npos) << result.err;
}

TEST(Convert, RefusesWhatHasNoMeaning) {
  const TempFolder folder;
  (void)folder.file("ball.yaml", kBall);
  (void)folder.file("two.yaml", R"(
palpate: 1
length: mm
layers:
  - {name: a, inside: {sphere: {center: [0, 0, 0], radius: 10}}}
  - {name: b, inside: {sphere: {center: [0, 0, 0], radius: 5}}}
)");
  (void)converted(folder, {"ball.yaml", "-o", "ball.vdb", "--voxel", "1"});
  (void)converted(folder, {"ball.yaml", "-o", "ball.stl", "--voxel", "1"});
  struct {
    std::vector<std::string> arguments;
    int exit_code;
    const char* says;
  } const cases[] = {
      {{"two.yaml", "-o", "two.stl", "--voxel", "1"}, 2, "a/surface, b/surface"},
      {{"ball.vdb", "-o", "other.vdb"}, 2, "already"},
      {{"ball.vdb", "-o", "a.txt"}, 3, ".stl, .obj, .ply or .glb"},
      {{"ball.vdb", "-o", "a.glb", "--to-units", "mm"}, 2, "meters"},
      {{"ball.vdb", "-o", "a.nii", "--to-units", "mm"}, 2, "meshes"},
      {{"ball.vdb", "-o", "ball.stl"}, 1, "--force"},
      {{"ball.vdb", "-o", "a.stl", "--layer", "bal"}, 3, "ball/surface"},
      {{"ball.vdb", "-o", "a.stl", "--layer", "ball", "--layer", "ball"}, 2, "twice"},
      {{"none.vdb", "-o", "a.stl"}, 3, "none.vdb"},
      {{"ball.vdb"}, 2, "-o OUTPUT"},
      {{}, 2, "INPUT"},
  };
  for (const auto& c : cases) {
    std::vector<std::string> arguments = c.arguments;
    arguments.insert(arguments.begin(), "convert");
    const CommandResult result = runPalpate(arguments, folder.path());
    EXPECT_EQ(result.exit_code, c.exit_code) << result.err;
    EXPECT_NE(result.err.find(c.says), std::string::npos) << c.says << " in: " << result.err;
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path()))
    ++files;
  EXPECT_EQ(files, 4U) << "nothing was left behind";
}

}  // namespace
}  // namespace palpate::testing
