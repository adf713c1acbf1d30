// Scene files that name meshes, grids and images: what is read when, notes, and places of errors.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/register.h"
#include "support/temp_file.h"
#include "vdb/nifti_writer.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;

class SceneKinds : public ::testing::Test {
 protected:
  SceneKinds() {
    // Two touching boxes of labels, 2 mm voxels, first center at (-19, -19, -19) mm, unit code 0.
    test::NiftiFile file;
    file.dim = {20, 20, 20};
    file.units = 0;
    file.sform = {{{2, 0, 0, -19}, {0, 2, 0, -19}, {0, 0, 2, -19}}};
    for (int k = 0; k < 20; ++k) {
      for (int j = 0; j < 20; ++j) {
        for (int i = 0; i < 20; ++i) {
          const bool in = i >= 4 && i < 16 && j >= 4 && j < 16 && k >= 4 && k < 16;
          file.values.push_back(in ? (i < 10 ? 1 : 2) : 0);
        }
      }
    }
    const test::Bytes bytes = test::bytesOf(file);
    (void)folder_.file("labels.nii", std::string(bytes.begin(), bytes.end()));
    (void)folder_.file("names.csv", "value,name\r\n1,left\r\n2,right\r\n7,nowhere\r\n");
    (void)folder_.file("octahedron.obj",
                       "v 10 0 0\nv -10 0 0\nv 0 10 0\nv 0 -10 0\nv 0 0 10\nv 0 0 -10\n"
                       "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
    options_.on_grid = [this](const GridRecord& record) { grids_.push_back(record); };
    options_.on_note = [this](const std::string& note) { notes_.push_back(note); };
    registerKinds(registry_, options_);
  }

  SceneDescription read(const std::string& body) {
    return readScene(folder_.file("scene.yaml", "palpate: 1\nlength: mm\n" + body), registry_);
  }

  /// Expects an error of `code` at a line and column of the scene, with the text `says`.
  void expectError(const std::string& body, const std::string& code, int line, int column,
                   const std::string& says) {
    try {
      (void)read(body);
      ADD_FAILURE() << "read without complaint:\n" << body;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_EQ(error.problem().code, code) << error.what();
      EXPECT_EQ(error.problem().file, folder_.path("scene.yaml")) << error.what();
      EXPECT_EQ(error.problem().line, line) << error.what();
      EXPECT_EQ(error.problem().column, column) << error.what();
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  }

  palpate::testing::TempFolder folder_;
  std::vector<GridRecord> grids_;
  std::vector<std::string> notes_;
  RegisterOptions options_;
  SceneRegistry registry_;
};

TEST_F(SceneKinds, LayersOfAnImageAreMadeWhenAskedForAndShareTheirGroup) {
  const SceneDescription scene = read(
      "images: {seg: {file: labels.nii, names: names.csv}, again: {file: labels.nii}}\n"
      "layers:\n"
      "  - {name: a, labels: {image: seg, match: [left]}}\n"
      "  - {name: b, labels: {image: seg, match: [\"r*\", 7], voxel: 1}}\n"
      "  - {name: c, threshold: {image: again, above: 0.5, fill: true}}\n");
  ASSERT_EQ(scene.layers.size(), 3U);
  EXPECT_EQ(scene.layers[0].label_group, "seg");
  EXPECT_EQ(scene.layers[1].label_group, "seg");
  EXPECT_EQ(scene.layers[2].label_group, "");
  EXPECT_EQ(scene.layers[1].inside->summary(), "labels 2 7 of labels.nii");
  EXPECT_EQ(scene.layers[2].inside->summary(), "labels.nii above 0.5");
  EXPECT_TRUE(grids_.empty());
  // Unit code 0 is noted once, although two images, three layers and their voxels use the file.
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("labels.nii"), std::string::npos);
  EXPECT_NE(notes_[0].find("taken as mm"), std::string::npos);

  for (const LayerDescription& layer : scene.layers) {
    EXPECT_FALSE(layer.inside->isMade());
    (void)layer.inside->get();
  }
  EXPECT_EQ(notes_.size(), 1U);
  ASSERT_EQ(grids_.size(), 3U);
  EXPECT_EQ(grids_[1].what, "b: labels 2 7 of labels.nii");
  EXPECT_EQ(grids_[1].info.name, "b/surface");
  EXPECT_EQ(grids_[1].info.metadata.at("layer"), "b");
  EXPECT_EQ(grids_[1].info.length_unit, "mm");
  EXPECT_NEAR(grids_[0].info.voxel_size, 2 * kMm, 1e-12);
  EXPECT_NEAR(grids_[1].info.voxel_size, 1 * kMm, 1e-12);

  // The labels' box runs from -12 to 12 mm, their common wall is x = 0.
  const Field& left = *scene.layers[0].inside->get();
  const Field& right = *scene.layers[1].inside->get();
  const Field& both = *scene.layers[2].inside->get();
  EXPECT_LT(left.value(Vec3(-6, 0, 0) * kMm), 0.0);
  EXPECT_GT(left.value(Vec3(6, 0, 0) * kMm), 0.0);
  EXPECT_LT(right.value(Vec3(6, 0, 0) * kMm), 0.0);
  // Each layer reaches slightly beyond the wall, which is where both have the same value.
  const Vec3 wall = Vec3(0, 1, 2) * kMm;
  EXPECT_NEAR(left.value(wall) - right.value(wall), 0.0, 0.02 * kMm);
  EXPECT_LT(left.value(wall), -0.1 * kMm);
  EXPECT_GT(left.value(wall), -1.0 * kMm);
  EXPECT_LT(both.value(Vec3(0, 0, 0)), 0.0);
}

// A grid knows distances in its band only: fields made from it must stay within the band.
TEST_F(SceneKinds, OffsetsShellsAndBlendsStayInTheBandOfAMesh) {
  const SceneDescription scene = read(
      "fields:\n"
      "  jewel: {mesh: {file: octahedron.obj, voxel: 0.5, half_width: 8}}\n"
      "  near: {offset: {field: jewel, distance: 1}}\n"
      "  peel: {shell: {field: jewel, thickness: 2}}\n"
      "  far: {offset: {field: jewel, distance: 5}}\n"
      "  soft: {smooth_union: {fields: [jewel, peel], radius: 5}}\n");
  EXPECT_EQ(scene.fields[1].source->summary(), "mesh octahedron.obj");
  // The face x + y + z = 10 mm is 2 / sqrt(3) mm from (4, 4, 4); it is flat, so that the grid holds
  // it accurately.
  EXPECT_NEAR(scene.fields[1].source->get()->value(Vec3(4) * kMm), (2 / std::sqrt(3.0) - 1) * kMm,
              0.01 * kMm);
  const Field& peel = *scene.fields[2].source->get();
  EXPECT_GT(peel.value(Vec3(0)), 0.0);
  EXPECT_LT(peel.value(Vec3(3) * kMm), 0.0);
  for (const auto& [index, line] : {std::pair{3U, 7}, std::pair{4U, 8}}) {
    try {
      (void)scene.fields[index].source->get();
      ADD_FAILURE() << scene.fields[index].name;
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, "field.band_too_narrow") << error.what();
      EXPECT_EQ(error.problem().file, folder_.path("scene.yaml"));
      EXPECT_EQ(error.problem().line, line);
      EXPECT_NE(error.problem().hint.find("band wider"), std::string::npos);
    }
  }
}

TEST_F(SceneKinds, MeshesAndGridsAreFields) {
  const FieldPtr ball = sphere(Vec3(1, 2, 3) * kMm, 10 * kMm);
  BakeOptions options;
  options.voxel_size = 1 * kMm;
  options.name = "ball/surface";
  const LevelSet baked = bake(*ball, options);
  writeVdb(folder_.path("ball.vdb"), std::span(&baked, 1), false);
  const SceneDescription scene = read(
      "fields:\n"
      "  plain: {mesh: {file: octahedron.obj, edges: rounded}}\n"
      "  big: {mesh: {file: octahedron.obj, units: cm, voxel: 2, half_width: 3}}\n"
      "  ball: {grid: {file: ball.vdb, name: ball/surface}}\n");
  ASSERT_EQ(scene.fields.size(), 3U);
  EXPECT_EQ(scene.fields[0].source->summary(), "mesh octahedron.obj");
  EXPECT_FALSE(scene.fields[0].source->isMade());
  const FieldPtr& plain = scene.fields[0].source->get();
  EXPECT_NEAR(plain->featureSize(), 20.0 / 128.0 * kMm, 1e-12);
  // The octahedron's face lies 10 / sqrt(3) from the origin.
  const Vec3 on_face = Vec3(10.0 / 3.0) * kMm;
  EXPECT_NEAR(plain->value(on_face), 0.0, 1e-6 * kMm);
  const FieldPtr& big = scene.fields[1].source->get();
  EXPECT_NEAR(big->value(10.0 * on_face), 0.0, 1e-5 * kMm);
  EXPECT_NEAR(grids_.at(1).info.half_width, 3.0, 1e-6);
  const FieldPtr& read_back = scene.fields[2].source->get();
  EXPECT_NEAR(read_back->value(Vec3(11, 2, 3) * kMm), 0.0, 0.03 * kMm);
  EXPECT_EQ(grids_.at(2).what, "ball.vdb: grid ball.vdb");
}

TEST_F(SceneKinds, MeshesOfFlatFacesKeepTheirEdgesUnlessAGridIsAskedFor) {
  const SceneDescription scene = read(
      "fields:\n"
      "  plain: {mesh: {file: octahedron.obj}}\n"
      "  asked: {mesh: {file: octahedron.obj, voxel: 0.5, edges: sharp}}\n"
      "  grid: {mesh: {file: octahedron.obj, voxel: 0.5}}\n"
      "  sharp: {mesh: {file: octahedron.obj, voxel: 0.5, sharp: 30}}\n");
  const Vec3 on_edge = Vec3(5.0, 0.0, 5.0) * kMm;
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}}) {
    const FieldPtr& exact = scene.fields[n].source->get();
    EXPECT_NEAR(exact->value(on_edge), 0.0, 1e-15);
    EXPECT_EQ(exact->structure().operands.size(), 8U);
  }
  EXPECT_TRUE(grids_.empty());
  EXPECT_GT(scene.fields[2].source->get()->value(on_edge), 0.02 * kMm);  // rounded off
  const FieldPtr& sharp = scene.fields[3].source->get();
  EXPECT_NEAR(sharp->value(on_edge), 0.0, 1e-12);
  EXPECT_TRUE(sharp->structure().operands.empty());
  EXPECT_EQ(grids_.size(), 2U);
}

TEST_F(SceneKinds, MeshesTakeASignAShellAndSmoothing) {
  // The octahedron without two of its faces: too open for a guess.
  (void)folder_.file("open.obj",
                     "v 10 0 0\nv -10 0 0\nv 0 10 0\nv 0 -10 0\nv 0 0 10\nv 0 0 -10\n"
                     "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\n");
  const SceneDescription scene = read(
      "fields:\n"
      "  open: {mesh: {file: open.obj, voxel: 0.5}}\n"
      "  lid: {mesh: {file: open.obj, voxel: 0.5, sign: winding}}\n"
      "  wall: {mesh: {file: open.obj, voxel: 0.5, shell: 2}}\n"
      "  round: {mesh: {file: octahedron.obj, voxel: 0.5, smooth: 90}}\n");
  EXPECT_THROW((void)scene.fields[0].source->get(), Error);
  EXPECT_LT(scene.fields[1].source->get()->value(Vec3(0)), 0.0);
  const Field& wall = *scene.fields[2].source->get();
  EXPECT_GT(wall.value(Vec3(0)), 0.0);
  // Half a millimeter outside the middle of a face and of the wall, where distances have a ridge.
  const double from_center = (10.0 / std::sqrt(3.0) + 0.5) * kMm;
  const Vec3 in_wall = from_center * glm::normalize(Vec3(-1.0, 1.0, 1.0));
  EXPECT_NEAR(wall.value(in_wall), -0.5 * kMm, 0.02 * kMm);
  // At its edges of 109 degrees normals turn by 70.5, which is below 90, so that faces bulge.
  EXPECT_LT(scene.fields[3].source->get()->value(Vec3(10.0 / 3.0) * kMm), -1.0 * kMm);
}

TEST_F(SceneKinds, AMeshSaysItsSpaceOrTheSceneDoes) {
  // A tetrahedron at x and y above 0.
  const std::string text =
      "v 1 1 0\nv 9 1 0\nv 1 9 0\nv 1 1 8\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  (void)folder_.file("plain.obj", text);
  (void)folder_.file("slicer.obj", "# SPACE=LPS\n" + text);
  const SceneDescription scene = read(
      "fields:\n"
      "  plain: {mesh: {file: plain.obj, voxel: 0.5}}\n"
      "  said: {mesh: {file: plain.obj, voxel: 0.5, space: LPS}}\n"
      "  stated: {mesh: {file: slicer.obj, voxel: 0.5}}\n"
      "  overruled: {mesh: {file: slicer.obj, voxel: 0.5, space: RAS}}\n");
  const Vec3 ras(2 * kMm, 2 * kMm, 2 * kMm);
  const Vec3 lps(-2 * kMm, -2 * kMm, 2 * kMm);
  const std::vector<bool> is_lps = {false, true, true, false};
  ASSERT_EQ(scene.fields.size(), is_lps.size());
  for (std::size_t i = 0; i < is_lps.size(); ++i) {
    const FieldPtr& field = scene.fields[i].source->get();
    EXPECT_LT(field->value(is_lps[i] ? lps : ras), 0.0) << scene.fields[i].name;
    EXPECT_GT(field->value(is_lps[i] ? ras : lps), 0.0) << scene.fields[i].name;
  }
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("slicer.obj: coordinates are LPS"), std::string::npos) << notes_[0];
}

TEST_F(SceneKinds, AnImagesOwnNamesAndColorsServe) {
  std::vector<std::pair<std::string, LabelColor>> colors;
  std::vector<ImageRecord> images;
  RegisterOptions options;
  options.on_color = [&](const std::string& layer, const LabelColor& color) {
    colors.emplace_back(layer, color);
  };
  options.on_image = [&](const ImageRecord& image) { images.push_back(image); };
  SceneRegistry registry;
  registerKinds(registry, options);
  std::string bytes =
      "NRRD0004\ntype: uchar\ndimension: 3\nspace: RAS\nsizes: 2 2 2\nencoding: raw\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nSegment0_Name:=liver\n"
      "Segment0_LabelValue:=3\nSegment0_Color:=1 0.5 0\n\n";
  bytes.append(8, '\3');
  (void)folder_.file("s.seg.nrrd", bytes);
  const std::string text =
      "palpate: 1\nlength: mm\nimages:\n  own: {file: s.seg.nrrd}\n"
      "  other: {file: s.seg.nrrd, names: names.csv}\nlayers:\n"
      "  - {name: a, labels: {image: own, match: [liver]}}\n"
      "  - {name: b, labels: {image: other, match: [right]}}\n";
  const SceneDescription scene = readScene(folder_.file("own.yaml", text), registry);
  EXPECT_EQ(scene.layers.size(), 2U);
  ASSERT_EQ(colors.size(), 1U);
  EXPECT_EQ(colors[0], (std::pair<std::string, LabelColor>("a", {1.0F, 0.5F, 0.0F})));
  ASSERT_EQ(images.size(), 2U);
  EXPECT_TRUE(images[0].is_labels);
}

TEST_F(SceneKinds, WhatCanBeKnownIsRefusedWhenTheSceneIsRead) {
  expectError("images: {i: {file: gone.nii}}\n", "nifti.missing", 3, 20, "gone.nii");
  expectError("images: {i: {file: names.csv}}\n", "image.format", 3, 20, "what kind of image");
  expectError("images: {i: {file: labels.nii, names: gone.csv}}\n", "labels.table_missing", 3, 39,
              "gone.csv");
  (void)folder_.file("bad.csv", "value,name\n1,a\nx,b\n");
  expectError("images: {i: {file: labels.nii, names: bad.csv}}\n", "labels.table_row", 3, 39,
              "bad.csv:3");
  expectError("fields: {m: {mesh: {file: gone.stl}}}\n", "scene.no_file", 3, 27, "gone.stl");
  expectError("fields: {m: {mesh: {file: octahedron.obj, space: up}}}\n", "scene.kind", 3, 50,
              "space: RAS or space: LPS");
  expectError("images: {i: {file: labels.nii, affine: best}}\n", "scene.kind", 3, 40,
              "affine: sform");
  expectError("images: {i: {file: labels.nii, frame: 1}}\n", "nifti.frame", 3, 20, "from 0");
  expectError("images: {i: {file: labels.nii, frame: -1}}\n", "scene.range", 3, 39, "whole number");
  expectError("images: {i: {file: labels.nii, space: LPS}}\n", "image.option", 3, 20, "NRRD");
  expectError("fields: {m: {mesh: {file: octahedron.obj, units: parsec}}}\n", "scene.unit", 3, 50,
              "parsec");
  expectError("fields: {m: {mesh: {file: octahedron.obj, voxel: -1}}}\n", "scene.range", 3, 50,
              "more than 0");
  expectError("fields: {m: {mesh: {file: octahedron.obj, half_width: 1}}}\n", "scene.range", 3, 55,
              "2 voxels");
  expectError("fields: {m: {mesh: {file: octahedron.obj, sign: even}}}\n", "scene.kind", 3, 49,
              "flood");
  expectError("fields: {m: {mesh: {file: octahedron.obj, shell: 0}}}\n", "scene.range", 3, 50,
              "more than 0");
  expectError("fields: {m: {mesh: {file: octahedron.obj, edges: round}}}\n", "scene.kind", 3, 50,
              "sharp or edges");
  expectError("fields: {m: {mesh: {file: octahedron.obj, sharp: 0}}}\n", "scene.range", 3, 50,
              "degrees");
  expectError("fields: {m: {mesh: {file: octahedron.obj, smooth: 190}}}\n", "scene.range", 3, 51,
              "180 degrees");
  expectError("fields: {m: {mesh: {file: octahedron.obj, voxle: 1}}}\n", "scene.unknown_key", 3, 43,
              "voxel");
  expectError("fields: {m: {grid: {file: gone.vdb}}}\n", "scene.no_file", 3, 27, "gone.vdb");

  const std::string images =
      "images: {seg: {file: labels.nii, names: names.csv}, bare: {file: labels.nii}}\n";
  const auto layer = [&](const std::string& surface) {
    return images + "layers:\n  - name: a\n    " + surface + "\n";
  };
  expectError(layer("labels: {image: sge, match: [left]}"), "scene.unknown_image", 6, 21, "'seg'");
  expectError(layer("labels: {image: seg, match: [1, lfet]}"), "labels.unknown", 6, 37, "`left`");
  expectError(layer("labels: {image: bare, match: [left]}"), "labels.no_names", 6, 35, "names");
  expectError(layer("labels: {image: seg, match: left}"), "scene.kind", 6, 33, "list");
  expectError(layer("labels: {image: seg, match: []}"), "scene.kind", 6, 33, "list");
  expectError(layer("labels: {image: seg}"), "scene.missing_key", 6, 13, "match");
  expectError(layer("threshold: {image: seg}"), "scene.missing_key", 6, 16, "above");
  expectError(layer("threshold: {image: seg, above: 1, below: 2}"), "scene.kind", 6, 46, "both");
  expectError(layer("threshold: {image: seg, above: 1, keep: biggest}"), "scene.kind", 6, 45,
              "keep: largest");
  EXPECT_TRUE(grids_.empty());
}

TEST_F(SceneKinds, WhatOnlyTheVoxelsKnowIsToldAtTheLayer) {
  const SceneDescription scene = read(
      "images: {seg: {file: labels.nii, names: names.csv}}\n"
      "layers:\n"
      "  - {name: a, labels: {image: seg, match: [nowhere]}}\n"
      "  - {name: b, threshold: {image: seg, above: 100}}\n");
  for (const auto& [index, line] : {std::pair{0U, 5}, {1U, 6}}) {
    try {
      (void)scene.layers[index].inside->get();
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, "scan.empty");
      EXPECT_EQ(error.problem().file, folder_.path("scene.yaml"));
      EXPECT_EQ(error.problem().line, line);
      EXPECT_NE(std::string(error.what()).find("labels.nii"), std::string::npos);
    }
  }
}

TEST_F(SceneKinds, CancellingAMakerLeavesItToBeMadeLater) {
  const SceneDescription scene = read(
      "images: {seg: {file: labels.nii}}\n"
      "layers:\n  - {name: a, threshold: {image: seg, above: 0.5}}\n");
  std::string first;
  try {
    (void)scene.layers[0].inside->get([&](std::string_view what, double) {
      first = what;
      return false;
    });
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  }
  EXPECT_EQ(first, "a: threshold");
  EXPECT_TRUE(grids_.empty());
  EXPECT_LT(scene.layers[0].inside->get()->value(Vec3(0.0)), 0.0);
}

}  // namespace
}  // namespace palpate::vdb
