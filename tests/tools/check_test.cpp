// palpate check: its findings in meshes and grids, and its exit code.

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "folders/folders.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

/// A cube of `side` about a point, as OBJ vertices and faces that wind outwards (or inwards).
std::string cube(double side, double x, int first_vertex, bool outwards = true,
                 std::size_t faces = 12) {
  static constexpr int kFaces[12][3] = {{1, 3, 4}, {1, 4, 2}, {5, 6, 8}, {5, 8, 7},
                                        {1, 2, 6}, {1, 6, 5}, {3, 7, 8}, {3, 8, 4},
                                        {1, 5, 7}, {1, 7, 3}, {2, 4, 8}, {2, 8, 6}};
  std::string text;
  for (int i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double at = (((i >> axis) & 1) != 0 ? 0.5 : -0.5) * side + (axis == 0 ? x : 0.0);
      text += (axis == 0 ? "v " : " ") + std::to_string(at);
    }
    text += "\n";
  }
  for (std::size_t f = 0; f < faces; ++f) {
    const int* const face = kFaces[f];
    text += "f " + std::to_string(face[0] + first_vertex - 1) + " " +
            std::to_string(face[outwards ? 1 : 2] + first_vertex - 1) + " " +
            std::to_string(face[outwards ? 2 : 1] + first_vertex - 1) + "\n";
  }
  return text;
}

struct Checked {
  int exit_code = -1;
  Json file;
  std::string text;
};

Checked checked(const TempFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "check");
  Checked c;
  c.text = runPalpate(arguments, folder.path()).out;
  arguments.emplace_back("--json");
  const CommandResult result = runPalpate(arguments, folder.path());
  c.exit_code = result.exit_code;
  const Json json = parseOnly(result);
  EXPECT_EQ(json["schema"], "palpate.check/1");
  EXPECT_EQ(json["ok"], result.exit_code == 0);
  if (json["files"].is_array() && !json["files"].empty()) c.file = json["files"][0];
  return c;
}

std::vector<std::string> codes(const Json& with_findings) {
  std::vector<std::string> all;
  for (const auto& finding : with_findings["findings"]) all.push_back(finding["code"]);
  return all;
}

TEST(Check, ASoundMeshIsAYes) {
  const TempFolder folder;
  (void)folder.file("cube.obj", cube(10.0, 3.0, 1));
  const Checked c = checked(folder, {"cube.obj", "--voxel", "0.5"});
  EXPECT_EQ(c.exit_code, 0);
  EXPECT_EQ(c.file["kind"], "mesh");
  EXPECT_TRUE(codes(c.file).empty()) << c.text;
  EXPECT_EQ(c.file["triangles"], 12);
  EXPECT_NEAR(c.file["volume_m3"], 1e-6, 1e-12);
  EXPECT_NEAR(c.file["area_m2"], 6e-4, 1e-10);
  EXPECT_TRUE(c.file["bake"]["ok"]);
  EXPECT_EQ(c.file["bake"]["voxel_size_m"], 0.5e-3);
  // Faces pass through voxel centers; edges are rounded by a share of a voxel.
  EXPECT_NEAR(c.file["bake"]["volume_m3"], 1e-6, 0.02e-6);
  EXPECT_NE(c.text.find("yes: nothing is wrong"), std::string::npos) << c.text;
  EXPECT_NE(c.text.find("encloses 1000 mm^3"), std::string::npos) << c.text;
}

TEST(Check, WhatABakeMendsIsToldAndIsAYes) {
  const TempFolder folder;
  // A closed cube, one that is inside out and has an extra triangle, and one that passes through
  // the first.
  (void)folder.file("many.obj", cube(10.0, 0.0, 1) + cube(4.0, 30.0, 9, false) + "f 9 11 12\n" +
                                    cube(6.0, 5.0, 17));
  const Checked c = checked(folder, {"many.obj", "--voxel", "0.5"});
  EXPECT_EQ(c.exit_code, 0) << c.text;
  const std::vector<std::string> found = codes(c.file);
  const auto has = [&](const char* code) {
    return std::find(found.begin(), found.end(), code) != found.end();
  };
  EXPECT_TRUE(has("mesh.inside_out")) << c.text;
  EXPECT_TRUE(has("mesh.doubled")) << c.text;
  EXPECT_TRUE(has("mesh.self_intersection")) << c.text;
  EXPECT_EQ(c.file["parts"], 3);
  // One solid made of both, 1000 + 216 - 108 mm^3, and the separate one.
  EXPECT_NEAR(c.file["bake"]["volume_m3"], (1000.0 + 216.0 - 108.0 + 64.0) * 1e-9, 25e-9) << c.text;
}

TEST(Check, AMeshThatABakeRefusesIsANo) {
  const TempFolder folder;
  (void)folder.file("open.obj", cube(10.0, 0.0, 1, true, 10));
  const Checked c = checked(folder, {"open.obj", "--voxel", "0.5"});
  EXPECT_EQ(c.exit_code, 1);
  EXPECT_EQ(codes(c.file), std::vector<std::string>{"mesh.holes"});
  EXPECT_EQ(c.file["boundary_edges"], 4);
  EXPECT_EQ(c.file["holes"], 1);
  EXPECT_NEAR(c.file["largest_holes"][0]["length_m"], 0.04, 1e-9);
  EXPECT_TRUE(c.file["volume_m3"].is_null());
  EXPECT_FALSE(c.file["bake"]["ok"]);
  EXPECT_EQ(c.file["bake"]["refused"]["code"], "mesh.open");
  EXPECT_NE(c.text.find("no: a bake"), std::string::npos) << c.text;
}

TEST(Check, AnUnlikelySizeIsAskedAbout) {
  const TempFolder folder;
  (void)folder.file("meters.obj", cube(0.1, 0.0, 1));
  const Checked c = checked(folder, {"meters.obj"});
  EXPECT_EQ(c.exit_code, 0);
  EXPECT_EQ(codes(c.file), std::vector<std::string>{"mesh.size"});
  EXPECT_NE(c.text.find("is its unit"), std::string::npos) << c.text;
  EXPECT_TRUE(codes(checked(folder, {"meters.obj", "--units", "m"}).file).empty());
}

TEST(Check, SeveralFilesAndBadOnes) {
  const TempFolder folder;
  (void)folder.file("good.obj", cube(10.0, 0.0, 1));
  (void)folder.file("open.obj", cube(10.0, 0.0, 1, true, 10));
  (void)folder.file("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  (void)folder.file("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  (void)folder.file("bad.vdb", "this is none");
  (void)folder.file("scan.nii", "an image");
  const CommandResult both = runPalpate({"check", "good.obj", "open.obj", "--json"}, folder.path());
  EXPECT_EQ(both.exit_code, 1);
  const Json json = parseOnly(both);
  EXPECT_TRUE(json["files"][0]["ok"]);
  EXPECT_FALSE(json["files"][1]["ok"]);
  const struct {
    const char* file;
    int exit_code;
    const char* code;
  } bad[] = {{"nan.obj", 3, "mesh.not_finite"},
             {"index.obj", 3, "mesh.index"},
             {"bad.vdb", 3, "vdb.unreadable"},
             {"none.stl", 3, "file.missing"},
             {"scan.nii", 3, "check.kind"}};
  for (const auto& b : bad) {
    const CommandResult result = runPalpate({"check", b.file, "--json"}, folder.path());
    EXPECT_EQ(result.exit_code, b.exit_code) << b.file;
    EXPECT_EQ(parseOnly(result)["error"]["code"], b.code);
  }
  EXPECT_EQ(runPalpate({"check"}).exit_code, 2);
  EXPECT_EQ(runPalpate({"check", "good.obj", "--units", "parsec"}, folder.path()).exit_code, 2);
  EXPECT_EQ(runPalpate({"check", "good.obj", "--voxel", "-1"}, folder.path()).exit_code, 2);
}

TEST(Check, PlacesAreInRasWhicheverWayTheAxesOfTheMeshRun) {
  const TempFolder folder;
  // A cube about (20, 0, 0) without its last two triangles; its hole is at y = 5 in the file's own
  // axes.
  (void)folder.file("open.obj", cube(10.0, 20.0, 1, true, 10));
  const auto hole = [&](const std::vector<std::string>& arguments) {
    const Json file = checked(folder, arguments).file;
    EXPECT_EQ(file["space"], arguments.size() > 1 ? arguments[2] : "RAS");
    EXPECT_EQ(file["space_stated"], false);
    for (const Json& finding : file["findings"]) {
      if (finding["code"] == "mesh.holes") return finding["place_m"];
    }
    ADD_FAILURE() << "no hole";
    return Json();
  };
  const Json as_is = hole({"open.obj"});
  const Json turned = hole({"open.obj", "--space", "LPS"});
  for (const std::size_t axis : {0U, 1U, 2U}) {
    const double sign = axis < 2 ? -1.0 : 1.0;
    EXPECT_NEAR(turned[axis].get<double>(), sign * as_is[axis].get<double>(), 1e-9);
  }
  EXPECT_GT(std::abs(as_is[0].get<double>()), 0.01);
  EXPECT_EQ(hole({"open.obj", "--space", "RAS"}), as_is);
  EXPECT_NE(checked(folder, {"open.obj", "--space", "LPS"}).text.find("LPS, as asked"),
            std::string::npos);
  EXPECT_EQ(runPalpate({"check", "open.obj", "--space", "up"}, folder.path()).exit_code, 2);
}

TEST(Check, GridsOfOthers) {
  const TempFolder folder;
  const std::string command = "/usr/bin/python3 '" + test::sourceFolder() +
                              "/tests/vdb/vdb_interop.py' '" + folder.path() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    std::string finding;  // code of the first finding, or of the refusal
  } cases[] = {
      {{"ball.vdb"}, 0, ""},
      {{"half.vdb"}, 0, ""},
      {{"no_class.vdb"}, 1, "vdb.class"},
      {{"no_class.vdb", "--level-set"}, 0, ""},
      {{"no_unit.vdb"}, 1, "vdb.no_unit"},
      {{"no_unit.vdb", "--units", "cm"}, 0, ""},
      {{"fog.vdb"}, 1, "vdb.class"},
      {{"mask.vdb"}, 1, "vdb.type"},
      {{"vectors.vdb"}, 1, "vdb.type"},
      {{"turned.vdb"}, 1, "vdb.transform"},
      {{"stretched.vdb"}, 1, "vdb.transform"},
      {{"empty.vdb"}, 1, "vdb.empty"},
      {{"hollow.vdb"}, 1, "grid.sign_break"},
      {{"in_voxels.vdb"}, 1, "grid.gradient"},
  };
  for (const auto& c : cases) {
    const Checked out = checked(folder, c.arguments);
    EXPECT_EQ(out.exit_code, c.exit_code) << c.arguments[0] << "\n" << out.text;
    const Json& grid = out.file["grids"][0];
    const std::vector<std::string> found = codes(grid);
    const std::string first = !found.empty() ? found.front()
                              : grid["refused"].is_object()
                                  ? grid["refused"]["code"].get<std::string>()
                                  : std::string();
    EXPECT_EQ(first, c.finding) << c.arguments[0] << "\n" << out.text;
  }
  const Checked ball = checked(folder, {"ball.vdb"});
  const Json& grid = ball.file["grids"][0];
  EXPECT_TRUE(grid["widened"]);
  EXPECT_NE(ball.text.find("widens its band to 6 voxels"), std::string::npos) << ball.text;
  EXPECT_NEAR(grid["gradient"]["mean"], 1.0, 0.005);
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(6e-3, 3.0);
  EXPECT_NEAR(grid["volume_m3"], volume, 0.01 * volume);
}

TEST(Check, WhatItRefusesIsNotTouchedAndWhatItTakesIs) {
  const TempFolder folder;
  const std::string command = "/usr/bin/python3 '" + test::sourceFolder() +
                              "/tests/vdb/vdb_interop.py' '" + folder.path() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  (void)folder.file("path.csv", "t,x,y,z\n0,0.02,0,0\n0.001,0.0195,0,0\n");
  for (const std::string name : {"ball", "half", "hollow", "in_voxels", "torn"}) {
    (void)folder.file("scene.yaml",
                      "palpate: 1\nlength: mm\nlayers:\n  - {name: solid, inside: {grid: "
                      "{file: " +
                          name + ".vdb}}}\n");
    const Checked check = checked(folder, {name + ".vdb"});
    const CommandResult touch =
        runPalpate({"touch", "scene.yaml", "--path", "path.csv", "--json"}, folder.path());
    EXPECT_EQ(check.exit_code == 0, touch.exit_code == 0) << name << "\n"
                                                          << check.text << touch.out;
    if (touch.exit_code == 0) continue;
    EXPECT_EQ(touch.exit_code, 3) << name;
    const Json grid = check.file["grids"][0];
    EXPECT_EQ(parseOnly(touch)["error"]["code"], grid["uncertified"]["code"]) << name;
  }
}

TEST(Check, WhatIsBakedHereIsAYes) {
  const TempFolder folder;
  (void)folder.file("c.yaml", kContainer);
  ASSERT_EQ(runPalpate({"bake", "c.yaml", "-o", "c.vdb", "--voxel", "1"}, folder.path()).exit_code,
            0);
  for (const std::string layer : {"", "liquid", "liquid/surface"}) {
    std::vector<std::string> arguments{"c.vdb"};
    if (!layer.empty()) arguments.insert(arguments.end(), {"--layer", layer});
    const Checked c = checked(folder, arguments);
    EXPECT_EQ(c.exit_code, 0) << c.text;
    EXPECT_FALSE(c.file["grids"][0]["widened"]);
  }
  EXPECT_EQ(runPalpate({"check", "c.vdb", "--layer", "solid"}, folder.path()).exit_code, 3);
}

}  // namespace
}  // namespace palpate::testing
