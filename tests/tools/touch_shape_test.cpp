// palpate touch MESH, IMAGE or GRID: a file with a surface can be touched by one command, as the
// scene that the command writes for it.

#include <cmath>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

constexpr const char* kBall =
    "palpate: 1\nlength: mm\nfields: {b: {sphere: {center: [5, 6, 7], radius: 20}}}\n"
    "layers: [{name: ball, inside: b}]\n";

/// A wedge with a slanted upper face: no vertical line meets it perpendicularly.
constexpr const char* kWedge =
    "v 0 0 0\nv 30 0 0\nv 0 20 0\nv 30 20 0\nv 0 0 15\nv 0 20 15\n"
    "f 1 3 4 2\nf 1 2 5\nf 3 6 4\nf 1 5 6 3\nf 2 4 6 5\n";

class TouchShape : public ::testing::Test {
 protected:
  TouchShape() {
    (void)folder_.file("ball.yaml", kBall);
    (void)folder_.file("wedge.obj", kWedge);
  }

  void make(const std::string& name, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"ball.yaml", "-o", name, "--voxel", "1"});
    (void)converted(folder_, more);
  }

  CommandResult touch(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "touch");
    arguments.emplace_back("--json");
    return runPalpate(arguments, folder_.path());
  }

  /// 2 mm below the found place at 500 N/m: 1 N, up to the error of the ball's facets and voxels.
  void expectPressed(const CommandResult& result, double tolerance = 0.02) {
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json json = parseOnly(result);
    EXPECT_NEAR(json["peak_force_N"], 1.0, tolerance) << json;
    EXPECT_NE(result.err.find("pressing on its surface at"), std::string::npos) << result.err;
  }

  TempFolder folder_;
};

TEST_F(TouchShape, AMesh) {
  make("ball.stl");
  expectPressed(touch({"ball.stl", "--voxel", "0.5"}));
}

TEST_F(TouchShape, AMeshOfFlatFacesIsExact) {
  const CommandResult result = touch({"wedge.obj"});
  expectPressed(result, 1e-6);
  EXPECT_NE(result.err.find("sharp edges"), std::string::npos) << result.err;
}

TEST_F(TouchShape, AGlbIsInMeters) {
  make("ball.glb");
  expectPressed(touch({"ball.glb"}));
}

TEST_F(TouchShape, AGrid) {
  make("ball.vdb");
  expectPressed(touch({"ball.vdb"}), 1e-3);
}

TEST_F(TouchShape, AnImage) {
  make("ball.nii.gz");
  // Distances in mm: values above -3 are all space except a ball of 17 mm, and the image's border
  // is the outer wall.
  expectPressed(touch({"ball.nii.gz", "--above", "-3"}), 0.05);
  const CommandResult none = touch({"ball.nii.gz"});
  EXPECT_EQ(none.exit_code, 2) << none.err;
  EXPECT_NE((none.err + none.out).find("--above VALUE"), std::string::npos) << none.err << none.out;
}

TEST_F(TouchShape, WhatIsGreaterThanAThresholdInAnImageOfDistancesIsTold) {
  make("ball.nii.gz");
  const CommandResult result = touch({"ball.nii.gz", "--above", "0"});
  EXPECT_NE(result.err.find("look like signed distances"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("--distances"), std::string::npos) << result.err;
}

TEST_F(TouchShape, AnImageOfDistancesIsWhatItWasMadeFrom) {
  make("ball.nii.gz");
  expectPressed(touch({"ball.nii.gz", "--distances"}), 1e-3);
  const CommandResult both = touch({"ball.nii.gz", "--distances", "--above", "0"});
  EXPECT_EQ(both.exit_code, 2) << both.err;
  EXPECT_NE((both.err + both.out).find("exclude one another"), std::string::npos) << both.out;
}

TEST_F(TouchShape, AMotionOfOnesOwn) {
  make("ball.vdb");
  const CommandResult result =
      touch({"ball.vdb", "--press", "5,6,27", "--depth", "1", "--hold", "0.1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(parseOnly(result)["peak_force_N"], 0.5, 1e-3);
}

TEST_F(TouchShape, TheSceneIsWrittenAndFeelsTheSame) {
  make("ball.vdb");
  const CommandResult first =
      touch({"ball.vdb", "--write-scene", "ball_scene.yaml", "--press", "5,6,27"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const CommandResult again = touch({"ball_scene.yaml", "--press", "5,6,27"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(parseOnly(first)["peak_force_N"], parseOnly(again)["peak_force_N"]);
  EXPECT_EQ(parseOnly(first)["written_scene"], "ball_scene.yaml");
}

TEST_F(TouchShape, OptionsThatDoNotApplyAreRefused) {
  make("ball.stl");
  make("ball.vdb");
  const std::vector<std::vector<std::string>> cases = {
      {"ball.stl", "--above", "3"},
      {"ball.stl", "--layer", "x"},
      {"ball.vdb", "--labels", "1"},
      {"ball.yaml", "--units", "mm", "--press", "0,0,0"},
      {"ball.yaml", "--write-scene", "x.yaml", "--press", "0,0,0"},
      {"ball.stl", "--write-scene", "x.txt"},
      {"ball.yaml"},
      {"ball.stl", "--taps", "3"}};
  for (const auto& arguments : cases) {
    EXPECT_EQ(touch(arguments).exit_code, 2) << arguments[0] << " " << arguments.back();
  }
  EXPECT_EQ(touch({"ball.vdb", "--layer", "none"}).exit_code, 3);
}

}  // namespace
}  // namespace palpate::testing
