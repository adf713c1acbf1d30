// Notes on a scene's walls before they are felt.

#include "tools/helpers.h"
#include "vdb/nifti_writer.h"

namespace palpate::testing {
namespace {

/// 24 voxels of 0.5 mm a side about the origin; each half along x has one gray value.
std::string halves(double left, double right) {
  vdb::test::NiftiFile file;
  file.dim = {24, 24, 24};
  file.sform = {{{0.5, 0, 0, -5.75}, {0, 0.5, 0, -5.75}, {0, 0, 0.5, -5.75}}};
  file.pixdim = {1, 0.5, 0.5, 0.5};
  file.values.resize(24UL * 24 * 24);
  for (std::size_t i = 0; i < file.values.size(); ++i) file.values[i] = i % 24 < 12 ? left : right;
  const auto bytes = vdb::test::bytesOf(file);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class WallNotes : public ::testing::Test {
 protected:
  void write(const std::string& material, const std::string& field) {
    (void)folder_.file("scene.yaml",
                       "palpate: 1\nlength: mm\nimages: {gray: {file: gray.nii}}\nmaterials:\n"
                       "  flesh: {" +
                           material + "}\nlayers:\n  - {name: ball, inside: {" + field +
                           "}, wall: flesh}\n");
  }
  CommandResult run(std::vector<std::string> arguments) {
    return runPalpate(arguments, folder_.path());
  }
  CommandResult touch() {
    return run({"touch", "scene.yaml", "--press", "0,0,5", "--normal", "0,0,1", "--hold", "0"});
  }
  TempFolder folder_;
};

const char* const kBall = "sphere: {center: [0, 0, 0], radius: 5}";
const char* const kMap = "stiffness: {image: gray, transfer: [[0, 300 N/m], [100, 3000 N/m]]}";

TEST_F(WallNotes, AContrastWithinAVoxelIsToldWithItsPlace) {
  (void)folder_.file("gray.nii", halves(0, 100));
  write(kMap, kBall);
  const CommandResult touched = touch();
  EXPECT_EQ(touched.exit_code, 0) << touched.err;
  const Json explained = parseOnly(run({"explain", "scene.yaml", "--json"}));
  ASSERT_EQ(explained["contrasts"].size(), 1U);
  const Json& contrast = explained["contrasts"][0];
  EXPECT_EQ(contrast["material"], "flesh");
  // Ten times as stiff over three voxels of a spline: the contrast is steepest on the soft side of
  // the middle.
  EXPECT_LT(contrast["length_m"].get<double>(), 0.5e-3);
  EXPECT_NEAR(contrast["at_m"][0].get<double>(), -0.3e-3, 0.5e-3);
  const double sideways = contrast["sideways"].get<double>();
  std::printf("  over %.3g mm, sideways %.2f\n", 1e3 * contrast["length_m"].get<double>(),
              sideways);
  EXPECT_GT(sideways, 0.2);
  EXPECT_LT(sideways, 1.0);
  const bool is_told = touched.err.find("the stiffness of flesh changes") != std::string::npos;
  EXPECT_EQ(is_told, sideways > 0.5) << touched.err;
  EXPECT_NE(run({"explain", "scene.yaml"}).out.find("the stiffness of flesh changes"),
            std::string::npos);
}

TEST_F(WallNotes, AnEvenMapIsNot) {
  (void)folder_.file("gray.nii", halves(50, 50));
  write(kMap, kBall);
  EXPECT_TRUE(parseOnly(run({"explain", "scene.yaml", "--json"}))["contrasts"].empty());
  EXPECT_EQ(touch().err.find("changes by"), std::string::npos);
}

TEST_F(WallNotes, ShadingBeyondTheBandOfAGridIsTold) {
  (void)folder_.file("gray.nii", halves(50, 50));
  write("stiffness: 900 N/m", kBall);
  const CommandResult baked = run({"bake", "scene.yaml", "-o", "ball.vdb", "--voxel", "0.25"});
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  const std::string grid = "grid: {file: ball.vdb, name: ball/surface}";
  write("stiffness: 900 N/m, shading: 0.3", grid);
  EXPECT_TRUE(parseOnly(run({"explain", "scene.yaml", "--json"}))["shading_gaps"].empty());
  write("stiffness: 900 N/m, shading: 3", grid);
  const Json explained = parseOnly(run({"explain", "scene.yaml", "--json"}));
  ASSERT_EQ(explained["shading_gaps"].size(), 1U);
  const Json& gap = explained["shading_gaps"][0];
  EXPECT_EQ(gap["layer"], "ball");
  EXPECT_EQ(gap["material"], "flesh");
  EXPECT_NEAR(gap["needed_m"].get<double>(), 4.5e-3, 1e-12);
  // A baked field has a band of some voxels of 0.25 mm.
  EXPECT_LT(gap["known_m"].get<double>(), 2e-3);
  EXPECT_GT(gap["known_m"].get<double>(), 0.45e-3);
  const std::string said = touch().err;
  EXPECT_NE(said.find("the shading of flesh needs"), std::string::npos) << said;
  EXPECT_NE(parseOnly(run({"check", "scene.yaml", "--json"})).dump().find("scene.shading_band"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::testing
