// palpate bake: writes scenes, meshes and images to .vdb files, and can be stopped.

#include <cmath>
#include <cstdio>

#include "support/scan_folder.h"
#include "tools/helpers.h"
#include "vdb/nifti_writer.h"

namespace palpate::testing {
namespace {

/// A cube of `side`, as an OBJ file with shared vertices and outward triangles.
std::string cubeObj(double side, std::size_t faces = 12) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    char line[96];
    std::snprintf(line, sizeof line, "v %g %g %g\n", (i & 1) != 0 ? side : 0.0,
                  (i & 2) != 0 ? side : 0.0, (i & 4) != 0 ? side : 0.0);
    text += line;
  }
  static constexpr int kFaces[12][3] = {{1, 3, 4}, {1, 4, 2}, {5, 6, 8}, {5, 8, 7},
                                        {1, 2, 6}, {1, 6, 5}, {3, 7, 8}, {3, 8, 4},
                                        {1, 5, 7}, {1, 7, 3}, {2, 4, 8}, {2, 8, 6}};
  for (std::size_t i = 0; i < faces; ++i) {
    text += "f " + std::to_string(kFaces[i][0]) + " " + std::to_string(kFaces[i][1]) + " " +
            std::to_string(kFaces[i][2]) + "\n";
  }
  return text;
}

/// A ball of value 100 (label 3) in an image of 24^3 voxels of 1 mm, and a small one of value 60
/// (label 5).
vdb::test::NiftiFile balls(bool labels) {
  vdb::test::NiftiFile file;
  file.dim = {24, 24, 24};
  file.sform = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  file.pixdim = {1, 1, 1, 1};
  for (int k = 0; k < 24; ++k) {
    for (int j = 0; j < 24; ++j) {
      for (int i = 0; i < 24; ++i) {
        const double large = std::hypot(i - 9, j - 10, k - 11);
        const double small = std::hypot(i - 19, j - 19, k - 19);
        file.values.push_back(large < 6.5   ? (labels ? 3 : 100)
                              : small < 2.5 ? (labels ? 5 : 60)
                                            : 0);
      }
    }
  }
  return file;
}

std::string writeImage(const TempFolder& folder, const std::string& name,
                       const vdb::test::NiftiFile& file) {
  const auto bytes = vdb::test::bytesOf(file);
  return folder.file(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Json onlyFile(const std::string& path) {
  const CommandResult result = runPalpate({"info", path, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  Json json = parseOnly(result);
  EXPECT_EQ(json["files"].size(), 1U);
  return json["files"][0];
}

TEST(Bake, AnOpenMeshTakesASignOrAShell) {
  const TempFolder folder;
  // A cube of 10 mm without its lid, a sixth of its faces.
  (void)folder.file("open.obj", cubeObj(10.0, 10));
  const std::vector<std::string> bake{"bake",    "open.obj", "-o",     "o.vdb",
                                      "--voxel", "0.5",      "--force"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = bake;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runPalpate(arguments, folder.path());
  };
  EXPECT_EQ(with({}).exit_code, 3);
  EXPECT_EQ(with({"--sign", "winding"}).exit_code, 0);
  EXPECT_EQ(with({"--shell", "2"}).exit_code, 0);
  const CommandResult none = with({"--shell", "0"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("--shell must be greater than 0"), std::string::npos) << none.err;
  EXPECT_EQ(with({"--sign", "winding", "--smooth", "30"}).exit_code, 0);
  EXPECT_EQ(with({"--smooth", "200"}).exit_code, 2);

  EXPECT_EQ(with({"--sign", "unsigned"}).exit_code, 0);
  const CommandResult refused = runPalpate({"convert", "o.vdb", "-o", "o.stl"}, folder.path());
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("holds distances without sign"), std::string::npos) << refused.err;
  EXPECT_EQ(with({"--sign", "unsigned", "--shell", "2"}).exit_code, 2);

  (void)folder.file("c.yaml", kContainer);
  const CommandResult smooth =
      runPalpate({"bake", "c.yaml", "-o", "c.vdb", "--smooth", "30"}, folder.path());
  EXPECT_EQ(smooth.exit_code, 2);
  EXPECT_NE(smooth.err.find("--smooth applies to meshes"), std::string::npos) << smooth.err;
  const CommandResult scene =
      runPalpate({"bake", "c.yaml", "-o", "c.vdb", "--sign", "flood"}, folder.path());
  EXPECT_EQ(scene.exit_code, 2);
  EXPECT_NE(scene.err.find("--sign applies to meshes"), std::string::npos) << scene.err;
}

TEST(Bake, ASceneGivesOneSurfaceForEachLayer) {
  const TempFolder folder;
  (void)folder.file("c.yaml", kContainer);
  const CommandResult result =
      runPalpate({"bake", "c.yaml", "-o", "c.vdb", "--voxel", "1", "--json"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  Json json = parseOnly(result);
  EXPECT_EQ(json["schema"], "palpate.bake/1");
  ASSERT_EQ(json["grids"].size(), 1U);
  EXPECT_EQ(json["grids"][0]["name"], "liquid/surface");
  EXPECT_NEAR(json["grids"][0]["voxel_size_m"], 1e-3, 1e-12);
  EXPECT_GT(json["grids"][0]["active_voxels"],
            10000);  // about 18 000 mm^2 of surface, 8 voxels thick

  Json info = onlyFile(folder.path("c.vdb"));
  EXPECT_EQ(info["kind"], "grids");
  EXPECT_EQ(info["grids"][0]["name"], "liquid/surface");
  EXPECT_EQ(info["grids"][0]["class"], "level set");
  EXPECT_EQ(info["grids"][0]["length_unit"], "mm");
  EXPECT_EQ(info["grids"][0]["metadata"]["layer"], "liquid");
  EXPECT_EQ(filesIn(folder.path()), (std::vector<std::string>{"c.vdb", "c.yaml"}));
}

TEST(Bake, OnlyTheLayersAskedFor) {
  const TempFolder folder;
  const std::string out = folder.path("v.vdb");
  const CommandResult result = runPalpate({"bake", scenePath("valve_tube.yaml"), "-o", out,
                                           "--voxel", "1", "--layer", "downstream", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  ASSERT_EQ(parseOnly(result)["grids"].size(), 1U);
  EXPECT_EQ(parseOnly(result)["grids"][0]["name"], "downstream/surface");

  const CommandResult slip = runPalpate(
      {"bake", scenePath("valve_tube.yaml"), "-o", folder.path("w.vdb"), "--layer", "downstraem"});
  EXPECT_EQ(slip.exit_code, 3);
  EXPECT_NE(slip.err.find("did you mean 'downstream'?"), std::string::npos) << slip.err;
}

TEST(Bake, AMeshNeedsItsUnit) {
  const TempFolder folder;
  (void)folder.file("cube.obj", cubeObj(1.0));
  const CommandResult noted =
      runPalpate({"bake", "cube.obj", "-o", "a.vdb", "--voxel", "0.05"}, folder.path());
  ASSERT_EQ(noted.exit_code, 0) << noted.err;
  EXPECT_NE(noted.err.find("taken as 1 mm"), std::string::npos) << noted.err;

  const CommandResult given =
      runPalpate({"bake", "cube.obj", "-o", "b.vdb", "--voxel", "0.05", "--units", "cm", "--json"},
                 folder.path());
  ASSERT_EQ(given.exit_code, 0) << given.err;
  EXPECT_EQ(given.err, "");
  Json grid = parseOnly(given)["grids"][0];
  EXPECT_EQ(grid["name"], "cube/surface");
  EXPECT_NEAR(grid["voxel_size_m"], 0.0005, 1e-12);
  // The band reaches at least one and at most half-width + 1 voxels beyond the cube of 1 cm.
  EXPECT_GT(grid["bounds_m"]["hi"][0], 0.0105);
  EXPECT_LT(grid["bounds_m"]["hi"][0], 0.0126);
}

TEST(Bake, AShapeSmallerThanAVoxelIsRefusedAndOneOfAVoxelIsTold) {
  const TempFolder folder;
  (void)folder.file(
      "ball.yaml",
      "palpate: 1\nlength: mm\nlayers:\n  - {name: ball, inside: {sphere: {center: [0, "
      "0, 0], radius: 30}}}\n");
  const auto bake = [&](const std::string& voxel) {
    return runPalpate({"bake", "ball.yaml", "-o", "ball.vdb", "--voxel", voxel, "--force"},
                      folder.path());
  };
  const CommandResult none = bake("500 mm");
  EXPECT_EQ(none.exit_code, 3) << none.out;
  EXPECT_NE(none.err.find("smaller than a voxel of 500 mm"), std::string::npos) << none.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path("ball.vdb")));
  const CommandResult told = bake("50 mm");
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_NE(told.err.find("bends within a voxel of 50 mm"), std::string::npos) << told.err;
  const CommandResult fine = bake("2 mm");
  EXPECT_EQ(fine.exit_code, 0) << fine.err;
  EXPECT_EQ(fine.err.find("bends within"), std::string::npos) << fine.err;
}

TEST(Bake, WhatVoxelsCannotHoldIsTold) {
  const TempFolder folder;
  (void)folder.file("crumb.yaml", R"(palpate: 1
length: mm
layers:
  - {name: ball, inside: {union: [{sphere: {center: [0, 0, 0], radius: 6}},
                                  {sphere: {center: [12.5, 0.5, 0.5], radius: 0.2}}]}}
)");
  const CommandResult result =
      runPalpate({"bake", "crumb.yaml", "-o", "c.vdb", "--voxel", "1", "--json"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(
      result.err.find("ball/surface lacks parts that its voxels cannot hold: 1 separate part"),
      std::string::npos)
      << result.err;
  EXPECT_NE(std::string(parseOnly(result)["grids"][0]["lost_parts"]).find("1 separate part"),
            std::string::npos)
      << result.out;
  const CommandResult fine =
      runPalpate({"bake", "crumb.yaml", "-o", "f.vdb", "--voxel", "0.2", "--json"}, folder.path());
  EXPECT_TRUE(parseOnly(fine)["grids"][0]["lost_parts"].is_null()) << fine.out;
}

TEST(Bake, AnImageByThresholdOrByLabel) {
  const TempFolder folder;
  const std::string gray = writeImage(folder, "gray.nii", balls(false));
  const CommandResult skin =
      runPalpate({"bake", gray, "-o", folder.path("g.vdb"), "--above", "50", "--json"});
  ASSERT_EQ(skin.exit_code, 0) << skin.err << skin.out;
  EXPECT_EQ(parseOnly(skin)["grids"][0]["name"], "gray/surface");
  // Only the large ball remains, whose radius is 6.5 mm about (9, 10, 11) mm.
  EXPECT_LT(parseOnly(skin)["grids"][0]["bounds_m"]["hi"][0], 0.0215);

  const CommandResult both = runPalpate(
      {"bake", gray, "-o", folder.path("h.vdb"), "--above", "50", "--keep", "all", "--json"});
  ASSERT_EQ(both.exit_code, 0) << both.err << both.out;
  EXPECT_GT(parseOnly(both)["grids"][0]["bounds_m"]["hi"][0], 0.0215);

  const std::string labels = writeImage(folder, "labels.nii", balls(true));
  const std::string names = folder.file("names.csv", "value,name\r\n3,kidney\r\n5,stone\r\n");
  const CommandResult organs = runPalpate({"bake", labels, "-o", folder.path("l.vdb"), "--labels",
                                           "stone,kidney", "--names", names, "--json"});
  ASSERT_EQ(organs.exit_code, 0) << organs.err << organs.out;
  Json json = parseOnly(organs);
  ASSERT_EQ(json["grids"].size(), 2U);
  EXPECT_EQ(json["grids"][0]["name"], "stone/surface");
  EXPECT_EQ(json["grids"][1]["name"], "kidney/surface");
  const CommandResult pattern = runPalpate(
      {"bake", labels, "-o", folder.path("m.vdb"), "--labels", "*", "--names", names, "--json"});
  ASSERT_EQ(pattern.exit_code, 0) << pattern.err << pattern.out;
  EXPECT_EQ(parseOnly(pattern)["grids"].size(), 2U);

  const CommandResult slip = runPalpate(
      {"bake", labels, "-o", folder.path("n.vdb"), "--labels", "kidny", "--names", names});
  EXPECT_EQ(slip.exit_code, 3);
  EXPECT_NE(slip.err.find("kidney"), std::string::npos) << slip.err;
}

// A plate of one voxel of 1 mm, beside a ball: voxels of 1 mm hold the plate, but it lies between
// voxels of 5 mm, whose centers are at 0 and 5 mm.
TEST(Bake, WhatTheVoxelsCannotHoldOfALabelIsTold) {
  const TempFolder folder;
  vdb::test::NiftiFile file = balls(true);
  for (std::size_t j = 3; j < 21; ++j) {
    for (std::size_t i = 3; i < 21; ++i) file.values[i + 24 * (j + 24 * 2)] = 3;
  }
  const std::string labels = writeImage(folder, "labels.nii", file);
  const CommandResult fine =
      runPalpate({"bake", labels, "-o", folder.path("f.vdb"), "--labels", "3"});
  ASSERT_EQ(fine.exit_code, 0) << fine.err;
  EXPECT_EQ(fine.err.find("lost"), std::string::npos) << fine.err;
  const CommandResult coarse =
      runPalpate({"bake", labels, "-o", folder.path("c.vdb"), "--labels", "3", "--voxel", "5"});
  ASSERT_EQ(coarse.exit_code, 0) << coarse.err;
  EXPECT_NE(coarse.err.find(" voxels of the scan lost"), std::string::npos) << coarse.err;
  EXPECT_NE(coarse.err.find(" 2) mm"), std::string::npos) << coarse.err;
}

TEST(Bake, NothingIsOverwrittenUnlessForced) {
  const TempFolder folder;
  (void)folder.file("c.yaml", kContainer);
  (void)folder.file("c.vdb", "mine");
  const CommandResult refused =
      runPalpate({"bake", "c.yaml", "-o", "c.vdb", "--json"}, folder.path());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(parseOnly(refused)["error"]["code"], "output.exists");
  EXPECT_EQ(textOf(folder.path("c.vdb")), "mine");
  EXPECT_EQ(runPalpate({"bake", "c.yaml", "-o", "c.vdb", "--voxel", "2", "--force"}, folder.path())
                .exit_code,
            0);
  EXPECT_NE(textOf(folder.path("c.vdb")), "mine");
}

TEST(Bake, MemoryIsRefusedBeforeItIsTaken) {
  const TempFolder folder;
  (void)folder.file("c.yaml", kContainer);
  const CommandResult refused = runPalpate(
      {"bake", "c.yaml", "-o", "c.vdb", "--voxel", "0.05", "--max-memory", "50MB", "--json"},
      folder.path());
  EXPECT_EQ(refused.exit_code, 1);
  const Json error = parseOnly(refused)["error"];
  EXPECT_EQ(error["code"], "bake.memory");
  // The message gives the estimate, the limit, and both remedies.
  EXPECT_NE(error["message"].get<std::string>().find(" GB; 0.050 GB"), std::string::npos) << error;
  EXPECT_NE(error["hint"].get<std::string>().find("voxels of "), std::string::npos) << error;
  EXPECT_NE(error["hint"].get<std::string>().find("--max-memory"), std::string::npos) << error;
  EXPECT_EQ(filesIn(folder.path()), std::vector<std::string>{"c.yaml"});

  EXPECT_EQ(runPalpate({"bake", "c.yaml", "-o", "c.vdb", "--voxel", "1", "--max-memory", "50 MB"},
                       folder.path())
                .exit_code,
            0);
  for (const char* bad : {"50", "much", "-1GB", "0B", "1e30TB"}) {
    const CommandResult slip =
        runPalpate({"bake", "c.yaml", "-o", "d.vdb", "--max-memory", bad}, folder.path());
    EXPECT_EQ(slip.exit_code, 2) << bad;
    EXPECT_NE(slip.err.find("500MB"), std::string::npos) << slip.err;
  }
}

TEST(Bake, TheLimitIsForAllGridsTogether) {
  const TempFolder folder;
  (void)folder.file("two.yaml", R"(palpate: 1
length: mm
fields:
  ball: {sphere: {center: [0, 0, 0], radius: 40}}
  other: {sphere: {center: [0, 0, 90], radius: 40}}
layers:
  - {name: ball, inside: ball}
  - {name: other, inside: other}
)");
  const auto bake = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"bake", "two.yaml", "-o",      "t.vdb",        "--voxel",
                                       "0.5",  "--json",   "--force", "--max-memory", "16MB"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runPalpate(arguments, folder.path());
  };
  EXPECT_EQ(bake({"--layer", "ball"}).exit_code, 0);
  EXPECT_EQ(bake({"--layer", "other"}).exit_code, 0);
  const CommandResult both = bake({});
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_EQ(parseOnly(both)["error"]["code"], "bake.memory");
}

TEST(Bake, AnInterruptStopsItAndLeavesNothing) {
  // A heart, for which closest points have to be searched: this takes far longer than the two
  // seconds after which progress is shown.
  const TempFolder folder;
  (void)folder.file("heart.yaml", R"(palpate: 1
length: mm
fields:
  heart: {heart: {center: [0, 0, 0], width: 80}}
layers:
  - {name: heart, inside: heart}
)");
  for (const int signal : {SIGINT, SIGTERM}) {
    const CommandResult result = runInterrupted(
        {"bake", "heart.yaml", "-o", "h.vdb", "--voxel", "0.1", "--json"}, folder.path(), signal);
    EXPECT_EQ(parseOnly(result)["error"]["code"], "cancelled");
    EXPECT_EQ(filesIn(folder.path()), std::vector<std::string>{"heart.yaml"});
  }
}

TEST(BakeSharedData, RealOrgansAndMeshes) {
  const std::string data = scanPath("");
  PALPATE_NEEDS_SCAN(data + "abdomen");
  PALPATE_NEEDS_SCAN(data + "meshes");
  const TempFolder folder;
  const CommandResult organs =
      runPalpate({"bake", data + "abdomen/example_seg.nii.gz", "-o", folder.path("o.vdb"),
                  "--labels", "liver,spleen,kidney_left,kidney_right,aorta", "--names",
                  data + "abdomen/labels.csv", "--json"});
  ASSERT_EQ(organs.exit_code, 0) << organs.err << organs.out;
  Json organ_json = parseOnly(organs);
  ASSERT_EQ(organ_json["grids"].size(), 6U);
  EXPECT_EQ(organ_json["grids"][5]["name"], "united") << "some of them touch";
  for (const Json& grid : organ_json["grids"]) EXPECT_GT(grid["active_voxels"], 100) << grid;
  for (const char* mesh : {"meshes/brain_region.stl", "meshes/footbones.ply"}) {
    const CommandResult result = runPalpate(
        {"bake", data + mesh, "-o", folder.path("m.vdb"), "--units", "mm", "--force", "--json"});
    ASSERT_EQ(result.exit_code, 0) << mesh << "\n" << result.err << result.out;
    EXPECT_GT(parseOnly(result)["grids"][0]["active_voxels"], 1000) << mesh;
  }
}

}  // namespace
}  // namespace palpate::testing
