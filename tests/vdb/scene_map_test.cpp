// Parameters of a scene from .vdb files and images: read as python3-openvdb writes them, felt
// accordingly, and otherwise refused with a place and a remedy.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "folders/folders.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/material_grid.h"
#include "palpate/vdb/register.h"
#include "support/error_of.h"
#include "support/temp_file.h"
#include "vdb/nifti_writer.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;

std::string oracle(const std::string& arguments) {
  const std::string command = "/usr/bin/python3 '" + palpate::test::sourceFolder() +
                              "/tests/vdb/material_grid_oracle.py' " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::string out;
  char line[256];
  while (pipe != nullptr && std::fgets(line, sizeof line, pipe) != nullptr) out += line;
  EXPECT_EQ(pclose(pipe), 0) << command << "\n" << out;
  return out;
}

class SceneMaps : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    home = new TempFolder;
    (void)oracle("write '" + home->path() + "'");
    // One row of voxels along x: -1000, -100, 100, 300, 3000 at 0, 2, ... 8 mm.
    test::NiftiFile image;
    image.dim = {5, 2, 2};
    image.datatype = 16;  // float
    for (int i = 0; i < 4; ++i) {
      for (const double v : {-1000.0, -100.0, 100.0, 300.0, 3000.0}) image.values.push_back(v);
    }
    image.sform = {{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}}};
    const test::Bytes bytes = test::bytesOf(image);
    (void)home->file("ct.nii", std::string(bytes.begin(), bytes.end()));
  }
  static void TearDownTestSuite() {
    delete home;
    home = nullptr;
  }

  static std::string text(const std::string& stiffness, const std::string& more = {}) {
    return "palpate: 1\nlength: mm\nimages: {ct: {file: ct.nii}}\nmaterials:\n  skin: "
           "{stiffness: " +
           stiffness + more +
           "}\nlayers:\n  - {name: skin, inside: {half_space: {point: [0, 0, 6], normal: [0, 0, "
           "1]}}, wall: skin}\n";
  }
  static SceneDescription read(const std::string& scene) {
    SceneRegistry registry;
    RegisterOptions options;
    options.on_note = [](const std::string& note) { notes += note + "\n"; };
    registerKinds(registry, options);
    return parseScene(scene, home->path("scene.yaml"), registry);
  }
  static Problem refusal(const std::string& scene) {
    return errorOf([&] { (void)read(scene); }).problem();
  }
  static inline TempFolder* home = nullptr;
  static inline std::string notes;
};

TEST_F(SceneMaps, AGridOfPythonsIsFeltAsItSays) {
  const SceneDescription description = read(text("{grid: {file: ramp.vdb, name: skin/stiffness}}"));
  const auto renderer = makeRenderer(compile(description));
  for (const double x : {2e-3, 7e-3, 13e-3, 18.5e-3}) {
    (void)renderer->update({.position = {x, 8e-3, 7e-3}});
    const TickResult out = renderer->update({.position = {x, 8e-3, 5e-3}});
    // 200 + 10 x [mm] N/m, 1 mm deep; plus half the gradient of stiffness, 1e4 N/m per m, times the
    // square of the depth.
    EXPECT_NEAR(out.force.z, (200.0 + 1e4 * x) * 1e-3, 1e-7) << x;
    EXPECT_NEAR(out.force.x, -0.5 * 1e-6 * 1e4, 1e-7) << x;
  }
}

TEST_F(SceneMaps, AGridOfOneValueIsFeltAsTheConstantBitForBit) {
  Image image;
  image.size = {9, 8, 7};
  image.axes = Mat3(3e-3);
  image.values.assign(9 * 8 * 7, 750.0F);
  const MaterialGridPtr grid = std::make_shared<const MaterialGrid>(image, 1e-3);
  const NamedMaterialGrid named = {"skin/stiffness", grid, "N/m", "mm", {}};
  writeVdb(home->path("flat.vdb"), {}, true, std::span(&named, 1));
  const auto of_grid = makeRenderer(compile(read(text("{grid: {file: flat.vdb}}"))));
  const auto of_constant = makeRenderer(compile(read(text("750 N/m"))));
  for (int i = 0; i < 500; ++i) {
    const HipState hip = {.position = {1e-4 * i, 5e-5 * i, 6e-3 - 2e-3 * std::sin(0.05 * i)}};
    const TickResult a = of_grid->update(hip);
    const TickResult b = of_constant->update(hip);
    ASSERT_EQ(a.force, b.force) << i;
    ASSERT_EQ(a.proxy, b.proxy) << i;
  }
}

TEST_F(SceneMaps, UnitsAreConverted) {
  const Parameter in_mm = read(text("{grid: {file: newtons_per_mm.vdb}}")).materials[0].stiffness;
  EXPECT_NEAR(in_mm.at({0.01, 0.008, 0.006}), 300e3, 0.1);
  const Parameter told =
      read(text("{grid: {file: no_unit.vdb, unit: kN/m}}")).materials[0].stiffness;
  EXPECT_NEAR(told.at({0.01, 0.008, 0.006}), 300e3, 0.1);
  const Parameter length =
      read(text("{grid: {file: no_length.vdb, units: m}}")).materials[0].stiffness;
  EXPECT_NEAR(length.at({10.0, 8.0, 6.0}), 300.0, 1e-4);
}

TEST_F(SceneMaps, AnImageIsFeltThroughItsTransferFunction) {
  notes.clear();
  const SceneDescription description = read(
      text("{image: ct, transfer: [[-100, 200 N/m], [300, 2 N/mm]]}",
           ", friction: {static: {image: ct, transfer: [[0, 0.5], [300, 0.2]], tolerance: 0.01}}"));
  const Parameter& stiffness = description.materials[0].stiffness;
  // At the third voxel: an eighth of each neighbor, and three quarters of its own value.
  EXPECT_NEAR(stiffness.at({4e-3, 0, 0}), 0.125 * 200.0 + 0.75 * 1100.0 + 0.125 * 2000.0, 0.02);
  EXPECT_EQ(stiffness.range().least, 200.0);
  EXPECT_NEAR(stiffness.range().most, 2000.0, 0.02);
  const auto grid = std::dynamic_pointer_cast<const MaterialGrid>(stiffness.map());
  ASSERT_NE(grid, nullptr);
  EXPECT_EQ(grid->info().quantisation.bits, 16);
  EXPECT_LE(grid->info().quantisation.error, 1800.0 / 65535.0 / 2.0 + 1e-6);
  const Parameter& friction = description.materials[0].friction.static_ratio;
  EXPECT_EQ(std::dynamic_pointer_cast<const MaterialGrid>(friction.map())->info().quantisation.bits,
            8);
  EXPECT_NE(notes.find("stiffness from"), std::string::npos) << notes;
  EXPECT_NE(notes.find("16 bits"), std::string::npos) << notes;
  EXPECT_NO_THROW((void)compile(description));
}

TEST_F(SceneMaps, AFlowComesFromAnImageAndMayBeBelowZero) {
  const SceneDescription description =
      read(text("100 N/m",
                ", viscosity: 2 N.s/m, flow: [{image: ct, transfer: [[-100, -20 mm/s], [300, 1 "
                "cm/s]]}, 0 mm/s, 5 mm/s]"));
  const Flow& flow = description.materials[0].flow;
  // -20, -5 and 10 mm/s at the second to fourth voxel: an eighth of each neighbor, and three
  // quarters of its own value.
  EXPECT_NEAR(flow.at({4e-3, 0, 0}).x, -5e-3, 1e-6);
  EXPECT_NEAR(flow.at({0, 0, 0}).x, -20e-3, 1e-6);
  EXPECT_NEAR(flow.x.range().least, -20e-3, 1e-6);
  EXPECT_NEAR(flow.x.range().most, 10e-3, 1e-6);
  EXPECT_EQ(flow.at({4e-3, 0, 0}).y, 0.0);
  EXPECT_EQ(flow.at({4e-3, 0, 0}).z, 5e-3);
  EXPECT_NO_THROW((void)compile(description));
  // A value that is not a velocity is refused with its place, and so is a stiffness below 0.
  EXPECT_EQ(
      refusal(text("100 N/m", ", flow: [{image: ct, transfer: [[0, 1 N]]}, 0 m/s, 0 m/s]")).code,
      "scene.quantity");
  EXPECT_EQ(refusal(text("{image: ct, transfer: [[0, -1 N/m]]}")).code, "scene.quantity");
}

struct Row {
  std::string stiffness;
  std::string code;
  std::string message;  ///< a part of it
  std::string hint;     ///< a part of it
  int column;
};

TEST_F(SceneMaps, WhatCannotBeIsRefusedAtItsPlaceWithARemedy) {
  // The stiffness begins at column 21 of line 5.
  for (const Row& row : {
           Row{"{grid: {file: no_unit.vdb}}", "vdb.no_value_unit", "no_unit.vdb", "unit: N/m", 35},
           Row{"{grid: {file: pascal.vdb}}", "vdb.value_unit", "'Pa'", "N/m", 35},
           Row{"{grid: {file: no_length.vdb}}", "vdb.no_unit", "length unit", "units: mm", 35},
           Row{"{grid: {file: level_set.vdb}}", "vdb.class", "level set", "fog volume", 35},
           Row{"{grid: {file: bools.vdb}}", "vdb.type", "BoolGrid", "FloatGrid", 35},
           Row{"{grid: {file: nan.vdb}}", "vdb.not_finite", "not numbers", "damaged", 35},
           Row{"{grid: {file: empty.vdb}}", "vdb.empty", "no active voxels", "", 35},
           Row{"{grid: {file: negative.vdb}}", "scene.range", "-5", "correct", 21},
           Row{"{grid: {file: nowhere.vdb}}", "scene.no_file", "nowhere.vdb", "folder", 35},
           Row{"{grid: {file: ramp.vdb, name: hide/stiffness}}", "vdb.no_grid", "hide/stiffness",
               "skin/stiffness", 35},
           Row{"{grid: {file: ramp.vdb, tolerance: 3}}", "scene.range", "'tolerance'", "N/m", 56},
           Row{"{image: mr, transfer: [[0, 1 N/m]]}", "scene.unknown_image", "'mr'", "ct", 29},
           Row{"{image: ct, transfer: 3}", "scene.kind", "'transfer'", "[[-100, 200 N/m]", 43},
           Row{"{image: ct, transfer: [[0, 100]]}", "scene.quantity", "'stiffness'", "N/m", 48},
           Row{"{image: ct, transfer: [[0, -1 N/m]]}", "scene.quantity", "'stiffness'", "N/m", 48},
           Row{"{image: ct, transfer: [[0, 1 N/m], [0, 2 N/m]]}", "scene.range",
               "smaller to larger", "sort", 57},
           Row{"{image: ct, transfer: [[a, 1 N/m]]}", "scene.kind", "is a number", "", 45},
           Row{"{picture: ct}", "scene.unknown_key", "'picture'", "grid, image", 22},
           Row{"{image: ct, transfer: [[0, 0 N/m], [9, 5 N/m]]}", "scene.range", "in some places",
               "more than 0 N/m", 0},
       }) {
    SCOPED_TRACE(row.stiffness);
    const Problem problem = refusal(text(row.stiffness));
    EXPECT_EQ(problem.code, row.code) << problem.message;
    EXPECT_NE(problem.message.find(row.message), std::string::npos) << problem.message;
    EXPECT_NE(problem.hint.find(row.hint), std::string::npos) << problem.hint;
    EXPECT_EQ(problem.file, home->path("scene.yaml"));
    if (row.column > 0) {
      EXPECT_EQ(problem.line, 5);
      EXPECT_EQ(problem.column, row.column);
    }
  }
}

TEST_F(SceneMaps, PythonReadsWhatIsWritten) {
  const Parameter stiffness =
      read(text("{grid: {file: ramp.vdb, tolerance: 1 N/m}}")).materials[0].stiffness;
  const auto grid = std::dynamic_pointer_cast<const MaterialGrid>(stiffness.map());
  ASSERT_NE(grid, nullptr);
  ASSERT_EQ(grid->info().quantisation.bits, 8);
  const NamedMaterialGrid named = {"skin/stiffness", grid, "N/m", "mm", {{"layer", "skin"}}};
  const std::string path = home->path("written.vdb");
  writeVdb(path, {}, true, std::span(&named, 1));
  // 11 x 9 x 7 voxels of 2 mm; with steps of 200 / 255 N/m, values that are 20 N/m apart have
  // errors of at most 0.39.
  const std::string out = oracle("read '" + path + "' skin/stiffness");
  int n[7];
  double p[6];
  double v[4];
  int on[4];
  ASSERT_EQ(std::sscanf(out.c_str(),
                        "%d %d %d %d %d %d %d %lf %lf %lf %lf %lf %lf %lf %d %lf %d %lf %d %lf %d",
                        n, n + 1, n + 2, n + 3, n + 4, n + 5, n + 6, p, p + 1, p + 2, p + 3, p + 4,
                        p + 5, v, on, v + 1, on + 1, v + 2, on + 2, v + 3, on + 3),
            21)
      << out;
  EXPECT_EQ(n[0], 11 * 9 * 7);
  EXPECT_EQ(n[4], 10);
  EXPECT_EQ(p[0], 0.0);
  EXPECT_EQ(p[3], 2.0);
  const Image stored = grid->voxels();
  EXPECT_EQ(v[0], static_cast<double>(stored.at(0, 0, 0)));
  EXPECT_EQ(v[1], static_cast<double>(stored.at(1, 0, 0)));
  EXPECT_EQ(v[2], static_cast<double>(stored.at(0, 2, 0)));
  EXPECT_EQ(v[3], static_cast<double>(stored.at(3, 2, 1)));
  EXPECT_NEAR(v[3], 260.0, 0.5 * 200.0 / 255.0 + 1e-4);
  EXPECT_EQ(on[3], 1);
}

}  // namespace
}  // namespace palpate::vdb
