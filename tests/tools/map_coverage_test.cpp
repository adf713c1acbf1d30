// Maps of parameters that do not lie where their layers are.

#include "tools/helpers.h"
#include "vdb/nifti_writer.h"

namespace palpate::testing {
namespace {

/// An image of 12 voxels of `voxel` [mm] a side, about `center` [mm]; gray values 0 and 100.
std::string image(double center, double voxel) {
  vdb::test::NiftiFile file;
  file.dim = {12, 12, 12};
  const double from = center - 5.5 * voxel;
  file.sform = {{{voxel, 0, 0, from}, {0, voxel, 0, -5.5 * voxel}, {0, 0, voxel, -5.5 * voxel}}};
  file.pixdim = {1, voxel, voxel, voxel};
  const auto bytes = vdb::test::bytesOf(file);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class MapCoverage : public ::testing::Test {
 protected:
  /// Writes a ball of 10 mm whose stiffness is a map from that image.
  void write(const std::string& nifti, const std::string& more = {}) {
    (void)folder_.file("gray.nii", nifti);
    (void)folder_.file(
        "scene.yaml",
        "palpate: 1\nlength: mm\nimages: {gray: {file: gray.nii}}\nmaterials:\n"
        "  flesh: {stiffness: {image: gray, transfer: [[0, 200 N/m], [99, 900 N/m]]}}\nlayers:\n"
        "  - {name: ball, inside: {sphere: {center: [0, 0, 0], radius: 10}}, wall: flesh}\n" +
            more);
  }
  CommandResult run(std::vector<std::string> arguments) {
    return runPalpate(arguments, folder_.path());
  }
  CommandResult touch() {
    return run({"touch", "scene.yaml", "--press", "0,0,10", "--normal", "0,0,1", "--hold", "0"});
  }
  TempFolder folder_;
};

TEST_F(MapCoverage, AMapElsewhereIsToldByTouchCheckAndExplain) {
  write(image(500.0, 2.0));  // half a meter away
  const CommandResult touched = touch();
  EXPECT_EQ(touched.exit_code, 0) << touched.err;
  // From 10 mm, the end of the ball, to 500 - 6 * 2 mm, the beginning of the map.
  EXPECT_NE(touched.err.find("the map of ball/stiffness"), std::string::npos) << touched.err;
  EXPECT_NE(touched.err.find("does not reach its layer: it lies 478 mm away"), std::string::npos)
      << touched.err;
  const Json checked = parseOnly(run({"check", "scene.yaml", "--json"}));
  EXPECT_NE(checked.dump().find("scene.map_misses"), std::string::npos) << checked.dump(1);
  const Json explained = parseOnly(run({"explain", "scene.yaml", "--json"}));
  ASSERT_EQ(explained["map_gaps"].size(), 1U);
  EXPECT_EQ(explained["map_gaps"][0]["name"], "ball/stiffness");
  EXPECT_EQ(explained["map_gaps"][0]["share"], 0.0);
  EXPECT_NEAR(explained["map_gaps"][0]["away_m"], 0.478, 1e-6);
}

TEST_F(MapCoverage, AMapOfHalfItsLayerIsTold) {
  write(image(12.0, 2.0));  // from x = 0 on
  const Json explained = parseOnly(run({"explain", "scene.yaml", "--json"}));
  ASSERT_EQ(explained["map_gaps"].size(), 1U);
  // Half of the ball is covered; of 17 planes of sample places one more or less counts.
  EXPECT_NEAR(explained["map_gaps"][0]["share"], 0.5, 0.06);
  EXPECT_NE(touch().err.find("% of its layer"), std::string::npos);
  const Json checked = parseOnly(run({"check", "scene.yaml", "--json"}));
  EXPECT_NE(checked.dump().find("scene.map_partial"), std::string::npos) << checked.dump(1);
}

TEST_F(MapCoverage, MetersReadAsMillimetersAreDoubted) {
  write(image(0.0, 0.002));  // an image whose author used meters
  const std::string said = touch().err;
  EXPECT_NE(said.find("times as long as the layer: is its length unit right"), std::string::npos)
      << said;
}

TEST_F(MapCoverage, AMapThatCoversItsLayerIsNotMentioned) {
  write(image(0.0, 2.0));
  EXPECT_EQ(touch().err.find("the map of"), std::string::npos);
  EXPECT_TRUE(parseOnly(run({"explain", "scene.yaml", "--json"}))["map_gaps"].empty());
}

TEST_F(MapCoverage, APortsMapIsHeldAgainstTheLayerBehindIt) {
  write(image(0.0, 2.0));
  (void)folder_.file("other.nii", image(500.0, 2.0));
  (void)folder_.file("scene.yaml",
                     "palpate: 1\nlength: mm\nimages: {other: {file: other.nii}}\nlayers:\n"
                     "  - {name: ball, inside: {sphere: {center: [0, 0, 0], radius: 10}}}\nports:\n"
                     "  - {name: cut, between: [outside, ball], opens_at: {image: other, transfer: "
                     "[[0, 1 N], [99, 2 N]]}}\n");
  const Json explained = parseOnly(run({"explain", "scene.yaml", "--json"}));
  ASSERT_EQ(explained["map_gaps"].size(), 1U);
  EXPECT_EQ(explained["map_gaps"][0]["name"], "cut/opens_at");
}

TEST_F(MapCoverage, AFlowAndTheForceOfAHoleAreHeldAgainstTheirLayersToo) {
  (void)folder_.file("other.nii", image(500.0, 2.0));
  (void)folder_.file(
      "scene.yaml",
      "palpate: 1\nlength: mm\nimages: {other: {file: other.nii}}\nmaterials:\n"
      "  stream: {viscosity: 2 N.s/m, flow: [{image: other, transfer: [[0, -5 mm/s], "
      "[99, 20 mm/s]]}, 0 m/s, 0 m/s]}\nlayers:\n"
      "  - {name: ball, inside: {sphere: {center: [0, 0, 0], radius: 10}}, content: "
      "stream}\nports:\n"
      "  - {name: cut, between: [outside, ball], opens_at: 3 N, hole: {radius: 2, "
      "reopens_at: {image: other, transfer: [[0, 0.1 N], [99, 1 N]]}}}\n");
  const CommandResult result = run({"explain", "scene.yaml", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json explained = parseOnly(result);
  ASSERT_EQ(explained["map_gaps"].size(), 2U) << explained["map_gaps"].dump(1);
  EXPECT_EQ(explained["map_gaps"][0]["name"], "ball/flow_x");
  EXPECT_EQ(explained["map_gaps"][1]["name"], "cut/reopens_at");
  EXPECT_NEAR(explained["ports"][0]["hole"]["reopens_at_N"]["most"], 1.0, 1e-4);
}

}  // namespace
}  // namespace palpate::testing
