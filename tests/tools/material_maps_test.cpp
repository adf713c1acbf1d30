// Maps of materials through the command: reported by explain, query and info, written by bake, and
// read back unchanged.

#include "tools/helpers.h"
#include "vdb/nifti_writer.h"

namespace palpate::testing {
namespace {

/// 16^3 voxels of 2 mm, about the origin; gray values from 0 to 150, rising along x, with waves
/// along y.
std::string grayImage(const TempFolder& folder) {
  vdb::test::NiftiFile file;
  file.dim = {16, 16, 16};
  file.datatype = 16;  // float
  file.sform = {{{2, 0, 0, -15}, {0, 2, 0, -15}, {0, 0, 2, -15}}};
  file.pixdim = {1, 2, 2, 2};
  for (int k = 0; k < 16; ++k) {
    for (int j = 0; j < 16; ++j) {
      for (int i = 0; i < 16; ++i) file.values.push_back(9 * i + (j % 4) + 0.25 * (k % 3));
    }
  }
  const auto bytes = vdb::test::bytesOf(file);
  return folder.file("gray.nii", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string sceneText(const std::string& inside, const std::string& stiffness,
                      const std::string& viscosity, const std::string& opens_at) {
  return "palpate: 1\nlength: mm\nimages: {gray: {file: gray.nii}}\nmaterials:\n  flesh: "
         "{stiffness: " +
         stiffness + ", viscosity: " + viscosity + "}\nlayers:\n  - {name: ball, inside: {" +
         inside +
         "}, wall: flesh, content: flesh}\nports:\n  - {name: cut, between: [outside, ball], "
         "opens_at: " +
         opens_at + "}\n";
}

std::string mapped(const std::string& inside) {
  return sceneText(inside, "{image: gray, transfer: [[0, 200 N/m], [150, 900 N/m]]}",
                   "{image: gray, transfer: [[0, 1 N.s/m], [150, 4 N.s/m]], tolerance: 0.01 N.s/m}",
                   "{image: gray, transfer: [[0, 0.4 N], [150, 0.8 N]]}");
}
const char* const kBall = "sphere: {center: [0, 0, 0], radius: 12}";

class MaterialMapFiles : public ::testing::Test {
 protected:
  MaterialMapFiles() {
    (void)grayImage(folder_);
    (void)folder_.file("scene.yaml", mapped(kBall));
  }
  Json asked(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const CommandResult result = runPalpate(arguments, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
    return parseOnly(result);
  }
  TempFolder folder_;
};

TEST_F(MaterialMapFiles, ExplainTellsHowTheyAreStored) {
  const Json maps = asked({"explain", "scene.yaml"})["maps"];
  ASSERT_EQ(maps.size(), 3U);
  EXPECT_EQ(maps[0]["name"], "ball/stiffness");
  EXPECT_EQ(maps[0]["unit"], "N/m");
  EXPECT_EQ(maps[0]["bits"], 16);
  EXPECT_LE(maps[0]["error"].get<double>(), 1e-5 * 700.0);
  EXPECT_NEAR(maps[0]["least"].get<double>(), 200.0, 1e-3);
  EXPECT_EQ(maps[1]["name"], "ball/viscosity");
  EXPECT_EQ(maps[1]["bits"], 8);
  EXPECT_GT(maps[1]["error"].get<double>(), 0.0);
  EXPECT_LE(maps[1]["error"].get<double>(), 0.01);
  EXPECT_EQ(maps[2]["name"], "cut/opens_at");
  const CommandResult text = runPalpate({"explain", "scene.yaml"}, folder_.path());
  EXPECT_NE(text.out.find("16 bits"), std::string::npos) << text.out;
}

TEST_F(MaterialMapFiles, QueryTellsTheValuesOfThePlace) {
  const Json points = asked({"query", "scene.yaml", "--at", "-5,0,0", "5,0,0"})["points"];
  const auto stiffness = [&](int i) {
    return points[static_cast<std::size_t>(i)]["wall"]["stiffness_N_per_m"].get<double>();
  };
  // 9 per voxel along x: 10 mm are 45 of 150, of a range of 700 N/m.
  EXPECT_NEAR(stiffness(1) - stiffness(0), 45.0 / 150.0 * 700.0, 0.05);
  EXPECT_GT(points[0]["content"]["viscosity_Ns_per_m"].get<double>(), 1.0);
}

TEST_F(MaterialMapFiles, BakeWritesThemAndASceneReadsThemBackTheSame) {
  const Json baked = asked({"bake", "scene.yaml", "-o", "body.vdb", "--voxel", "0.5"});
  ASSERT_EQ(baked["grids"].size(), 1U);
  ASSERT_EQ(baked["material_grids"].size(), 3U);
  EXPECT_EQ(baked["material_grids"][0]["name"], "ball/stiffness");

  const Json grids = asked({"info", "body.vdb"})["files"][0]["grids"];
  ASSERT_EQ(grids.size(), 4U);
  for (const Json& grid : grids) {
    EXPECT_EQ(grid["type"], "FloatGrid");
    EXPECT_EQ(grid["length_unit"], "mm");
    EXPECT_TRUE(grid["metadata"].contains("layer"));
    EXPECT_TRUE(grid["metadata"].contains("source"));
    if (grid["name"] == "ball/surface") continue;
    EXPECT_EQ(grid["class"], "fog volume");
    EXPECT_TRUE(grid["metadata"].contains("tolerance"));
    EXPECT_TRUE(grid["metadata"].contains("unit"));
  }

  // The same body from the file, surface and all: it feels the same as with the maps of the image.
  const auto grid = [](const std::string& name) {
    return "{grid: {file: body.vdb, name: " + name + "}}";
  };
  const std::string surface = "grid: {file: body.vdb, name: ball/surface}";
  (void)folder_.file("image.yaml", mapped(surface));
  (void)folder_.file("back.yaml", sceneText(surface, grid("ball/stiffness"), grid("ball/viscosity"),
                                            grid("cut/opens_at")));
  const auto trace = [&](const std::string& scene) {
    const CommandResult result = runPalpate({"touch", scene + ".yaml", "--insert", "4,3,16",
                                             "-3,2,-1", "--back", "--trace", scene + ".csv"},
                                            folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return linesOf(textOf(folder_.path(scene + ".csv")));
  };
  const auto image = trace("image");
  const auto back = trace("back");
  ASSERT_EQ(image.size(), back.size());
  bool is_inside = false;
  for (std::size_t i = 1; i < image.size(); ++i) {
    const auto a = cellsOf(image[i]);
    const auto b = cellsOf(back[i]);
    ASSERT_EQ(a[10], b[10]) << "region in line " << i;
    ASSERT_EQ(a[12], b[12]) << "event in line " << i;
    is_inside = is_inside || a[10] == "ball";
    // Place and scale of the voxels are rounded once when written, to the last bit of a double.
    for (std::size_t c = 7; c < 10; ++c) ASSERT_NEAR(std::stod(a[c]), std::stod(b[c]), 1e-9) << i;
  }
  EXPECT_TRUE(is_inside) << "the port opened";
}

TEST_F(MaterialMapFiles, InfoListsTheMapsOfAScene) {
  const Json scene = asked({"info", "scene.yaml"})["files"][0];
  ASSERT_EQ(scene["maps"].size(), 3U);
  EXPECT_EQ(scene["maps"][2]["name"], "cut/opens_at");
  EXPECT_EQ(scene["maps"][2]["unit"], "N");
}

TEST_F(MaterialMapFiles, ABadFileIsNamedWithItsRemedy) {
  (void)folder_.file("bad.yaml", sceneText(kBall, "{grid: {file: scene.yaml}}", "1 N.s/m", "1 N"));
  const CommandResult result = runPalpate({"explain", "bad.yaml"}, folder_.path());
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.err.find("bad.yaml:5:"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("not a .vdb file"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace palpate::testing
