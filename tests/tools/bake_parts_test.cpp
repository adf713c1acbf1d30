// palpate bake on shapes with edges: what a grid of the whole loses, and that --parts keeps it.

#include <cmath>
#include <cstdio>
#include <numbers>

#include "palpate/core/math.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

/// A rotated box, a shell of one voxel, and a rotated box of foam with a hole in it; in mm.
constexpr const char* kShapes = R"(palpate: 1
length: mm
description: "edges: kept, not baked"
fields:
  block: {box: {center: [0, 0, 0], size: [60, 40, 50]}}
  wave: {gyroid: {center: [0, 0, 0], period: 30}}
  ball: {sphere: {center: [100.31, 0.47, -0.22], radius: 20}}
  hollow: {sphere: {center: [100.31, 0.47, -0.22], radius: 19}}
  bore: {cylinder: {center: [0, 100, 0], axis: [0, 0, 1], radius: 6, height: 80}}
materials: {skin: {stiffness: 500 N/m}}
layers:
  - {name: box, inside: {transform: {field: block, rotate: {axis: [1, 2, 3], degrees: 40}, translate: [1.3, -0.4, 0.6]}}, wall: skin}
  - {name: peel, inside: {difference: [ball, hollow]}}
  - name: foam  # in block style
    inside:
      difference:
        - transform: {field: {intersection: [block, wave]}, rotate: {axis: [1, 2, 3], degrees: 40}, translate: [0, 100, 0]}
        - bore
ports:
  - {name: hole, between: [outside, foam], on: bore}
)";
const Pose kTurned{rotationAbout(Vec3(1.0, 2.0, 3.0), 40.0 * std::numbers::pi / 180.0),
                   Vec3(1.3, -0.4, 0.6)};
const Vec3 kHalf(30.0, 20.0, 25.0);

/// Points within half a voxel of the surface of the rotated box, and within two of one of its
/// edges.
std::vector<Vec3> nearEdges() {
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) {
    const int along = i % 3;
    Vec3 q(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const double share = std::sin(1.0 + 1.7 * i + 2.9 * axis);
      q[axis] = axis == along ? 0.8 * kHalf[axis] * share
                              : kHalf[axis] - (axis == (along + 1) % 3 ? 0.5 * share : 1.0 + share);
    }
    points.push_back(kTurned.apply(q));
  }
  return points;
}

std::string pointsCsv(const std::vector<Vec3>& points) {
  std::string text = "x,y,z\n";
  for (const Vec3& p : points) {
    char line[96];
    std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g\n", p.x, p.y, p.z);
    text += line;
  }
  return text;
}

Vec3 vectorOf(const Json& json) { return {json[0], json[1], json[2]}; }

struct Answer {
  double value;  // [mm]
  Vec3 gradient;
};

std::vector<Answer> ask(const TempFolder& folder, const std::string& scene,
                        const std::string& field) {
  const CommandResult result =
      runPalpate({"query", scene, "--field", field, "--points", "p.csv", "--json"}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  const Json json = parseOnly(result);
  std::vector<Answer> answers;
  for (const Json& point : json["points"]) {
    const Json& sample = point["fields"][0];
    answers.push_back({sample["value"], vectorOf(sample["gradient"])});
  }
  return answers;
}

double degreesBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

struct Errors {
  double value = 0.0;   // [mm] largest
  double normal = 0.0;  // [degrees] RMS
};

Errors compare(const std::vector<Answer>& truth, const std::vector<Answer>& got) {
  EXPECT_EQ(truth.size(), got.size());
  EXPECT_GT(truth.size(), 0U);
  Errors errors;
  for (std::size_t i = 0; i < std::min(truth.size(), got.size()); ++i) {
    errors.value = std::max(errors.value, std::fabs(truth[i].value - got[i].value));
    const double turn = degreesBetween(truth[i].gradient, got[i].gradient);
    errors.normal += turn * turn / static_cast<double>(truth.size());
  }
  errors.normal = std::sqrt(errors.normal);
  return errors;
}

class BakeParts : public ::testing::Test {
 protected:
  BakeParts() {
    (void)folder_.file("s.yaml", kShapes);
    (void)folder_.file("p.csv", pointsCsv(nearEdges()));
  }
  CommandResult bake(std::vector<std::string> more, const std::string& input = "s.yaml") {
    std::vector<std::string> arguments{"bake", input, "--voxel", "1", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runPalpate(arguments, folder_.path());
  }
  /// The foam, wherever it is cut off, is somewhere too thin for a single grid.
  CommandResult bakeWhole() {
    return bake({"-o", "whole.vdb", "--layer", "box", "--layer", "peel"});
  }
  TempFolder folder_;
};

TEST_F(BakeParts, AGridOfTheWholeTellsWhatItLoses) {
  const CommandResult result = bakeWhole();
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const Json json = parseOnly(result);
  ASSERT_EQ(json["grids"].size(), 2U);
  for (const Json& grid : json["grids"]) {
    SCOPED_TRACE(grid["name"].get<std::string>());
    EXPECT_FALSE(grid["error"]["holds_shape"].get<bool>());
    EXPECT_GT(grid["error"]["turn_degrees"], 10.0);
    EXPECT_NE(
        result.err.find(grid["name"].get<std::string>() + " cannot hold the shape everywhere"),
        std::string::npos)
        << result.err;
  }
  EXPECT_NE(result.err.find("--parts"), std::string::npos) << result.err;

  // A shape without edges loses nothing, and gets no note.
  (void)folder_.file("ball.yaml",
                     "palpate: 1\nlength: mm\nlayers:\n"
                     "  - {name: ball, inside: {sphere: {center: [0, 0, 0], radius: 20}}}\n");
  const CommandResult ball = bake({"-o", "ball.vdb"}, "ball.yaml");
  ASSERT_EQ(ball.exit_code, 0) << ball.err;
  EXPECT_EQ(ball.err, "");
  const Json error = parseOnly(ball)["grids"][0]["error"];
  EXPECT_TRUE(error["holds_shape"].get<bool>());
  EXPECT_LT(error["turn_degrees"], 0.01);
  EXPECT_LT(error["off_m"], 1e-7);
}

TEST_F(BakeParts, EdgesAndThinShellsStayExactThroughTheCommand) {
  const CommandResult result = bake({"-o", "parts.vdb", "--parts", "hybrid.yaml"});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const Json json = parseOnly(result);
  EXPECT_EQ(json["scene"], "hybrid.yaml");
  // Of the foam only the wave became a grid: all other parts are exact, have edges, or carry a
  // port.
  ASSERT_EQ(json["grids"].size(), 1U) << json;
  EXPECT_EQ(json["grids"][0]["name"], "foam/surface/1.2");
  EXPECT_EQ(filesIn(folder_.path()),
            (std::vector<std::string>{"hybrid.yaml", "p.csv", "parts.vdb", "s.yaml"}));
  ASSERT_EQ(bakeWhole().exit_code, 0);
  (void)folder_.file("whole.yaml",
                     "palpate: 1\nlength: mm\nlayers:\n"
                     "  - {name: box, inside: {grid: {file: whole.vdb, name: box/surface}}}\n"
                     "  - {name: peel, inside: {grid: {file: whole.vdb, name: peel/surface}}}\n");

  // Up to the rounding of a few centimeters: 1e-16 of that, in mm.
  const Errors box = compare(ask(folder_, "s.yaml", "box"), ask(folder_, "hybrid.yaml", "box"));
  const Errors box_grid = compare(ask(folder_, "s.yaml", "box"), ask(folder_, "whole.yaml", "box"));
  EXPECT_LE(box.value, 1e-12);
  EXPECT_LE(box.normal, 1e-6);
  EXPECT_GT(box_grid.normal, 5.0);

  // At the edges of the foam's box, where the foam is solid, the faces are as exact as before.
  std::vector<Vec3> turned_back = nearEdges();
  for (Vec3& p : turned_back) p = kTurned.applyInverse(p);
  (void)folder_.file("p.csv", pointsCsv(turned_back));
  const std::vector<Answer> wave = ask(folder_, "s.yaml", "wave");
  ASSERT_EQ(wave.size(), turned_back.size());
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < wave.size(); ++i) {
    if (wave[i].value < -2.0) points.push_back(kTurned.rotate(turned_back[i]) + Vec3(0, 100, 0));
  }
  EXPECT_GT(points.size(), 50U);
  (void)folder_.file("p.csv", pointsCsv(points));
  const Errors foam = compare(ask(folder_, "s.yaml", "foam"), ask(folder_, "hybrid.yaml", "foam"));
  EXPECT_LE(foam.value, 1e-12);
  EXPECT_LE(foam.normal, 1e-6);

  // Across the shell, from 0.9 mm outside to 0.9 mm inside.
  points.clear();
  for (int i = 0; i < 300; ++i) {
    const Vec3 u =
        glm::normalize(Vec3(std::sin(1.3 * i), std::sin(2.1 * i + 1), std::cos(3.7 * i)));
    points.push_back(Vec3(100.31, 0.47, -0.22) + (19.5 + 0.9 * std::sin(5.1 * i)) * u);
  }
  (void)folder_.file("p.csv", pointsCsv(points));
  const Errors shell = compare(ask(folder_, "s.yaml", "peel"), ask(folder_, "hybrid.yaml", "peel"));
  const Errors shell_grid =
      compare(ask(folder_, "s.yaml", "peel"), ask(folder_, "whole.yaml", "peel"));
  EXPECT_LE(shell.value, 1e-12);
  EXPECT_LE(shell.normal, 1e-6);
  EXPECT_GT(shell_grid.normal, 5.0);
  std::printf(
      "voxel 1 mm, by parts / one grid, normals RMS: edges of a box %.1e / %.1f degrees, a shell "
      "of a "
      "voxel %.1e / %.1f, edges of foam %.1e\n",
      box.normal, box_grid.normal, shell.normal, shell_grid.normal, foam.normal);
}

TEST_F(BakeParts, TheSceneIsFeltAsBeforeFromAnotherFolderToo) {
  std::filesystem::create_directory(folder_.path("out"));
  ASSERT_EQ(bake({"-o", "out/parts.vdb", "--parts", "out/hybrid.yaml"}).exit_code, 0);
  const auto touch = [&](const std::string& scene) {
    // Press onto an edge of the rotated box.
    const Vec3 p = kTurned.apply(kHalf * Vec3(0.1, 1.0, 1.0));
    const Vec3 n = kTurned.rotate(Vec3(0.0, 0.6, 0.8));
    const auto text = [](const Vec3& v) {
      char out[96];
      std::snprintf(out, sizeof out, "%.17g,%.17g,%.17g", v.x, v.y, v.z);
      return std::string(out);
    };
    const CommandResult result = runPalpate(
        {"touch", scene, "--press", text(p), "--normal", text(n), "--json"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parseOnly(result);
  };
  const Json before = touch("s.yaml");
  const Json after = touch("out/hybrid.yaml");
  EXPECT_EQ(before["regions"], after["regions"]);
  EXPECT_GT(before["regions"].dump().size(), 10U);
}

TEST_F(BakeParts, SaysWhyThereIsNothingToDo) {
  const CommandResult nothing = bake({"-o", "a.vdb", "--parts", "a.yaml", "--layer", "box"});
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_EQ(parseOnly(nothing)["error"]["code"], "bake.no_parts");
  EXPECT_NE(nothing.err.find("layer box stays analytic: it has edges"), std::string::npos)
      << nothing.err;
  (void)folder_.file("m.stl", "solid m\nendsolid m\n");
  EXPECT_EQ(bake({"-o", "a.vdb", "--parts", "a.yaml"}, "m.stl").exit_code, 2);
  // The output would overwrite the input
  EXPECT_EQ(bake({"-o", "a.vdb", "--parts", "s.yaml"}).exit_code, 2);
  EXPECT_EQ(filesIn(folder_.path()), (std::vector<std::string>{"m.stl", "p.csv", "s.yaml"}));
}

}  // namespace
}  // namespace palpate::testing
