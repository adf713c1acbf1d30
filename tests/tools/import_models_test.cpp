// palpate import of models: meshes as Slicer exports a segmentation.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "palpate/vdb/image.h"
#include "palpate/vdb/mesh.h"
#include "tools/imported.h"

namespace palpate::testing {
namespace {

/// A ball of `radius` [mm] around a center [mm] as the command makes it, of triangles.
void writeBall(const TempFolder& folder, const std::string& file, const Vec3& center,
               double radius) {
  const auto number = [](double x) { return std::to_string(x); };
  (void)folder.file("ball.yaml",
                    "{palpate: 1, length: mm, materials: {m: {stiffness: 1 N/mm}}, layers: [{name: "
                    "ball, inside: {sphere: {center: [" +
                        number(center.x) + ", " + number(center.y) + ", " + number(center.z) +
                        "], radius: " + number(radius) + "}}, wall: m}]}");
  const CommandResult made =
      runPalpate({"convert", "ball.yaml", "-o", file, "--voxel", "1mm", "--force"}, folder.path());
  ASSERT_EQ(made.exit_code, 0) << made.err;
}

TEST(ImportModels, AFolderOfMeshesIsASceneThatAHandFeels) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.path("models"));
  writeBall(folder, "models/Model_7_x.stl", Vec3(0.0), 20.0);
  writeBall(folder, "models/liver.ply", Vec3(5.0, 0.0, 0.0), 10.0);
  (void)folder.file("names.txt", "7 fat 0 0 0 255\n9 spleen 0 0 0 255\n");
  for (const bool is_listed : {false, true}) {
    std::vector<std::string> arguments = {"import"};
    if (is_listed) {
      arguments.insert(arguments.end(), {"models/Model_7_x.stl", "models/liver.ply"});
    } else {
      arguments.emplace_back("models");
    }
    arguments.insert(arguments.end(), {"--names", "names.txt", "--voxel", "0.5mm", "-o",
                                       "models.yaml", "--force", "--json"});
    const CommandResult result = runPalpate(arguments, folder.path());
    ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
    const vdb::Image labels = vdb::readImage(folder.path("models.labels.nii.gz"));
    EXPECT_NEAR(glm::length(labels.axes[0]), 0.5e-3, 1e-9);
    // The surface may be off by half a voxel's diagonal, 0.43 mm, and by a tenth of a millimeter,
    // the error of the triangles.
    double away = 1e9;
    for (const TracedTick& tick :
         touched(folder, "models.yaml", {Vec3(0, -30, 0), Vec3(0, -17, 0)}, "20mm/s")) {
      if (glm::length(tick.force) > 0.05) away = std::min(away, glm::length(tick.proxy));
    }
    EXPECT_NEAR(away, 20.0, 0.55);
  }
  const std::string scene = textOf(folder.path("models.yaml"));
  EXPECT_NE(scene.find("name: fat"), std::string::npos) << scene;
  EXPECT_NE(scene.find("name: liver"), std::string::npos) << scene;
}

TEST(ImportModels, AnOpenMeshAndOptionsOfImagesAreRefused) {
  const TempFolder folder;
  (void)folder.file("a.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"import", "a.obj", "-o", "a.yaml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runPalpate(arguments, folder.path());
  };
  const CommandResult open = refused({});
  EXPECT_EQ(open.exit_code, 3);
  EXPECT_NE(
      open.err.find(
          "hint: repair it in a mesh editor; or make a closed mesh of it: palpate convert a.obj"),
      std::string::npos)
      << open.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path("a.yaml")));
  EXPECT_EQ(refused({"--affine", "sform"}).exit_code, 2);
  (void)folder.file("b.nii.gz", "");
  EXPECT_EQ(refused({"b.nii.gz"}).exit_code, 3) << "neither masks nor models";
}

}  // namespace
}  // namespace palpate::testing
