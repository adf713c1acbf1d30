// The kinds of palpate::vdb read exactly the keys that the schema of scene files allows.
#include "support/scene_vocabulary.h"

#include <gtest/gtest.h>

#include "palpate/vdb/register.h"
#include "support/temp_file.h"
#include "vdb/nifti_writer.h"

namespace palpate::vdb {
namespace {

using palpate::testing::kNoKey;
using palpate::testing::readerKeys;
using palpate::testing::schemaKeys;

TEST(SceneVocabulary, KindsOfVdbAndTheSchemaKnowTheSameKeys) {
  const palpate::testing::TempFolder folder;
  test::NiftiFile image;
  image.dim = {2, 2, 2};
  image.values.assign(8, 1);
  const test::Bytes bytes = test::bytesOf(image);
  (void)folder.file("i.nii", std::string(bytes.begin(), bytes.end()));
  // Its existence is checked when the scene is read.
  (void)folder.file("m.stl", "");
  (void)folder.file("g.vdb", "");

  SceneRegistry registry;
  registerKinds(registry);
  const auto keys_in = [&](const std::string& body) {
    std::string scene = "palpate: 1\nlength: mm\n" + body;
    scene.replace(scene.find('@'), 1, std::string(kNoKey) + ": 1");
    return readerKeys(scene, registry, folder.path("scene.yaml"));
  };
  EXPECT_EQ(keys_in("fields: {f: {mesh: {file: m.stl, @}}}\n"), schemaKeys("mesh"));
  EXPECT_EQ(keys_in("fields: {f: {grid: {file: g.vdb, @}}}\n"), schemaKeys("grid"));
  EXPECT_EQ(keys_in("fields: {f: {mask: {file: g.vdb, @}}}\n"), schemaKeys("mask"));
  EXPECT_EQ(
      keys_in("fields: {b: {sphere: {center: [0, 0, 0], radius: 1}}, f: {baked: {field: b, @}}}\n"),
      schemaKeys("baked"));
  EXPECT_EQ(keys_in("fields: {f: {@}}\n"), schemaKeys("field_kind"));
  EXPECT_EQ(keys_in("images: {i: {file: i.nii, @}}\n"), schemaKeys("image"));
  EXPECT_EQ(keys_in("materials: {m: {stiffness: {grid: {file: g.vdb, @}}}}\n"),
            schemaKeys("material_grid"));
  EXPECT_EQ(keys_in("materials: {m: {viscosity: {grid: {file: g.vdb}, @}}}\n"),
            schemaKeys("map_of_grid"));
  EXPECT_EQ(keys_in("images: {i: {file: i.nii}}\nmaterials: {m: {damping: {image: i, transfer: "
                    "[[0, 1 N.s/m]], @}}}\n"),
            schemaKeys("map_of_image"));
  const std::string layer = "images: {i: {file: i.nii}}\nlayers:\n  - {name: a, ";
  EXPECT_EQ(keys_in(layer + "labels: {image: i, match: [1], @}}\n"), schemaKeys("labels"));
  EXPECT_EQ(keys_in(layer + "threshold: {image: i, above: 0, @}}\n"), schemaKeys("threshold"));
  EXPECT_EQ(keys_in(layer + "labels: {image: i, match: [1]}, @}\n"), schemaKeys("layer"));
}

}  // namespace
}  // namespace palpate::vdb
