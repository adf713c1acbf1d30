// The meaning of a scene file after it is read.

#include "palpate/scene/scene_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "folders/folders.h"
#include "lib/scene/problems.h"
#include "lib/scene/stand_in_readers.h"
#include "palpate/scene/scene.h"
#include "support/temp_file.h"

namespace palpate {
namespace {

// A container as the documents show it first: a ball cut by a plane, open at the brim.
constexpr std::string_view kContainer =
    R"(palpate: 1                       # container with liquid, the paper's Table I
length: mm
fields:
  bowl: {sphere: {center: [0, 0, 0], radius: 40}}
  brim: {half_space: {point: [0, 0, 15], normal: [0, 0, 1]}}      # inside is below
materials:
  glass: {stiffness: 1500 N/m, damping: 1 N.s/m, friction: {static: 0.2, kinetic: 0.15}}
  syrup: {viscosity: 4 N.s/m}
layers:
  - {name: liquid, inside: {intersection: [bowl, brim]}, content: syrup, wall: glass}
ports:
  - {name: mouth, between: [outside, liquid], on: brim}
)";

// The second scene that the documents show: a scanned head.
constexpr std::string_view kHead = R"(palpate: 1                       # a scanned head
length: mm
images:
  labels: {file: labels.nii.gz, names: labels.txt}
layers:
  - {name: scalp, labels: {image: labels, match: [scalp, fat]}, wall: skin, content: fat}
  - {name: skull, labels: {image: labels, match: ["skull*"]}, wall: bone}
materials: {skin: {stiffness: 400 N/m}, bone: {stiffness: 2000 N/m}, fat: {viscosity: 2 N.s/m}}
ports:
  - {name: cut, between: [outside, scalp], opens_at: 2.8 N, back: 1 N}
)";

SceneDescription sceneWith(const std::string& rest) {
  return parseScene("palpate: 1\nlength: mm\n" + rest, "folder/test.yaml", standInReaders());
}

FieldPtr fieldOf(const std::string& value) {
  return sceneWith("fields:\n  f: " + value + "\n").fields.at(0).source->get();
}

TEST(SceneFile, ContainerOfTheDesign) {
  const SceneDescription scene = parseScene(kContainer, "container.yaml");
  EXPECT_EQ(scene.file, "container.yaml");
  EXPECT_EQ(scene.length_unit, "mm");
  EXPECT_EQ(scene.meters_per_unit, 0.001);
  EXPECT_EQ(scene.start_region, "outside");
  EXPECT_EQ(scene.renderer, RendererKind::kConstraint);
  EXPECT_FALSE(scene.keep_memory);

  ASSERT_EQ(scene.materials.size(), 2U);
  EXPECT_EQ(scene.materials[0].name, "glass");
  EXPECT_EQ(scene.materials[0].stiffness, 1500.0);
  EXPECT_EQ(scene.materials[0].damping, 1.0);
  EXPECT_EQ(scene.materials[0].friction.static_ratio, 0.2);
  EXPECT_EQ(scene.materials[0].friction.kinetic_ratio, 0.15);
  EXPECT_EQ(scene.materials[1].viscosity, 4.0);

  ASSERT_EQ(scene.fields.size(), 2U);
  EXPECT_EQ(scene.fields[0].name, "bowl");
  EXPECT_EQ(scene.fields[1].name, "brim");

  ASSERT_EQ(scene.layers.size(), 1U);
  const LayerDescription& liquid = scene.layers[0];
  EXPECT_EQ(liquid.name, "liquid");
  EXPECT_EQ(liquid.content, "syrup");
  EXPECT_EQ(liquid.wall.material, "glass");
  EXPECT_FALSE(liquid.wall.absent);
  EXPECT_EQ(liquid.place.line, 10);
  // The liquid is inside the bowl and below the brim; values are in meters.
  const FieldPtr inside = liquid.inside->get();
  EXPECT_NEAR(inside->value(Vec3(0.0)), -0.015, 1e-15);
  EXPECT_NEAR(inside->value(Vec3(0.0, 0.0, -0.05)), 0.01, 1e-15);

  ASSERT_EQ(scene.ports.size(), 1U);
  const PortDescription& mouth = scene.ports[0];
  EXPECT_EQ(mouth.name, "mouth");
  EXPECT_EQ(mouth.from, "outside");
  EXPECT_EQ(mouth.to, "liquid");
  EXPECT_EQ(mouth.on_name, "brim");
  EXPECT_EQ(mouth.direction, PortDirection::kBoth);
  EXPECT_EQ(mouth.opens_at, 0.0);
  EXPECT_FALSE(mouth.back.has_value());
  EXPECT_TRUE(mouth.after.empty());
  EXPECT_EQ(mouth.where, nullptr);
}

TEST(SceneFile, ANamedFieldIsOneObjectWhereverItIsUsed) {
  const SceneDescription scene = parseScene(kContainer, "container.yaml");
  const FieldPtr& brim = scene.fields[1].source->get();
  EXPECT_EQ(scene.ports[0].on->get(), brim);
  const FieldStructure inside = scene.layers[0].inside->get()->structure();
  ASSERT_EQ(inside.kind, FieldStructure::Kind::kIntersection);
  ASSERT_EQ(inside.operands.size(), 2U);
  EXPECT_EQ(inside.operands[0], scene.fields[0].source->get());
  EXPECT_EQ(inside.operands[1], brim);
}

TEST(SceneFile, HeadOfTheDesign) {
  const SceneDescription scene = parseScene(kHead, "head.yaml", standInReaders());
  ASSERT_EQ(scene.layers.size(), 2U);
  EXPECT_EQ(scene.layers[0].label_group, scene.layers[1].label_group);
  EXPECT_FALSE(scene.layers[0].label_group.empty());
  EXPECT_FALSE(scene.layers[0].inside->isMade());
  EXPECT_NE(scene.layers[0].inside->summary().find("labels.nii.gz"), std::string::npos);
  EXPECT_EQ(scene.layers[1].content, "");
  ASSERT_EQ(scene.ports.size(), 1U);
  EXPECT_EQ(scene.ports[0].opens_at, 2.8);
  EXPECT_EQ(scene.ports[0].back, 1.0);
}

TEST(SceneFile, TheSameSceneAsJson) {
  const SceneDescription scene = parseScene(
      R"({"palpate":1,"length":"mm","fields":{"ball":{"sphere":{"center":[0,0,0],"radius":4e1}}},)"
      R"("materials":{"glass":{"stiffness":"1500 N/m"}},)"
      R"("layers":[{"name":"ball","inside":"ball","wall":"glass"}]})",
      "scene.json");
  EXPECT_NEAR(scene.layers[0].inside->get()->value(Vec3(0.0)), -0.04, 1e-15);
  EXPECT_EQ(scene.materials[0].stiffness, 1500.0);
}

TEST(SceneFile, LengthsAreInTheUnitNamed) {
  for (const auto& [unit, meters] :
       {std::pair{"m", 1.0}, std::pair{"cm", 0.01}, std::pair{"mm", 0.001}, std::pair{"um", 1e-6},
        std::pair{"in", 0.0254}}) {
    const SceneDescription scene =
        parseScene("palpate: 1\nlength: " + std::string(unit) +
                       "\nfields: {f: {sphere: {center: [0, 0, 0], radius: 3}}}\n",
                   "test.yaml");
    EXPECT_EQ(scene.length_unit, unit);
    EXPECT_NEAR(scene.fields[0].source->get()->value(Vec3(0.0)), -3.0 * meters, 1e-15) << unit;
  }
  // A length with its own unit does not depend on the file's unit.
  EXPECT_NEAR(fieldOf("{sphere: {center: [0, 0, 0], radius: 3 cm}}")->value(Vec3(0.0)), -0.03,
              1e-15);
  EXPECT_NEAR(fieldOf("{sphere: {center: [1 cm, 0, 0], radius: 1}}")->value(Vec3(0.01, 0.0, 0.0)),
              -0.001, 1e-15);
}

TEST(SceneFile, EveryKindOfField) {
  // Distances at a point where each formula is simple; in meters.
  const Vec3 p(0.010, 0.0, 0.0);
  const auto value = [&](const std::string& text) { return fieldOf(text)->value(p); };
  EXPECT_NEAR(value("{half_space: {point: [0, 0, 0], normal: [2, 0, 0]}}"), 0.010, 1e-15);
  EXPECT_NEAR(value("{sphere: {center: [0, 0, 0], radius: 4}}"), 0.006, 1e-15);
  EXPECT_NEAR(value("{box: {center: [0, 0, 0], size: [4, 40, 40]}}"), 0.008, 1e-15);
  EXPECT_NEAR(value("{cylinder: {center: [0, 0, 0], axis: [1, 0, 0], radius: 40, height: 4}}"),
              0.008, 1e-15);
  EXPECT_NEAR(value("{ellipsoid: {center: [0, 0, 0], radii: [4, 2, 3]}}"), 0.006, 1e-12);
  const std::string a = "{sphere: {center: [0, 0, 0], radius: 4}}";
  const std::string b = "{sphere: {center: [0, 0, 0], radius: 7}}";
  EXPECT_NEAR(value("{union: [" + a + ", " + b + "]}"), 0.003, 1e-15);
  EXPECT_NEAR(value("{intersection: [" + a + ", " + b + "]}"), 0.006, 1e-15);
  EXPECT_NEAR(value("{difference: [" + b + ", " + a + "]}"), 0.003, 1e-15);
  EXPECT_NEAR(value("{complement: " + a + "}"), -0.006, 1e-15);
  // Rotated about the origin first, then shifted: (0, 10, 0) is rotated to (-10, 0, 0) and shifted
  // to (4, 0, 0).
  const std::string away = "{sphere: {center: [0, 10, 0], radius: 4}}";
  EXPECT_NEAR(value("{transform: {field: " + away +
                    ", rotate: {axis: [0, 0, 3], degrees: 90}, translate: [14, 0, 0]}}"),
              0.002, 1e-15);
  EXPECT_NEAR(value("{transform: {field: " + away + ", translate: [6, -10, 0]}}"), 0.0, 1e-15);
  EXPECT_NEAR(value("{transform: {field: " + away + ", rotate: {axis: [0, 0, 1], degrees: -90}}}"),
              -0.004, 1e-15);
}

TEST(SceneFile, NamesMayBeUsedBeforeTheyAreDefined) {
  const SceneDescription scene = sceneWith(
      "fields:\n"
      "  both: {union: [left, right]}\n"
      "  alias: both\n"
      "  left: {sphere: {center: [-5, 0, 0], radius: 1}}\n"
      "  right: {sphere: {center: [5, 0, 0], radius: 1}}\n");
  ASSERT_EQ(scene.fields.size(), 4U);
  EXPECT_EQ(scene.fields[0].name, "both");
  EXPECT_EQ(scene.fields[0].source->get(), scene.fields[1].source->get());
  EXPECT_EQ(scene.fields[0].source->get()->structure().operands[1], scene.fields[3].source->get());
}

TEST(SceneFile, WhatCostsWorkIsMadeOnlyWhenAskedFor) {
  int made = 0;
  SceneRegistry registry = standInReaders();
  registry.fields["mesh"] = [&made](MapReader& reader) {
    return std::make_shared<FieldSource>("mesh " + reader.requireText("file"),
                                         [&made](const Progress&) {
                                           ++made;
                                           return sphere(Vec3(0.0), 0.004);
                                         });
  };
  const SceneDescription scene = parseScene(
      "palpate: 1\nlength: mm\n"
      "fields:\n"
      "  bone: {mesh: {file: bone.stl}}\n"
      "  cut: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}\n"
      "  half: {intersection: [bone, cut]}\n"
      "  moved: {transform: {field: half, translate: [1, 0, 0]}}\n"
      "  unused: {mesh: {file: other.stl}}\n",
      "test.yaml", registry);
  EXPECT_EQ(made, 0);
  const FieldSource& bone = *scene.fields[0].source;
  const FieldSource& moved = *scene.fields[3].source;
  EXPECT_TRUE(scene.fields[1].source->isMade());
  EXPECT_FALSE(moved.isMade());
  EXPECT_EQ(moved.summary(), "mesh bone.stl");
  const FieldPtr whole = moved.get();
  EXPECT_EQ(made, 1);
  EXPECT_TRUE(bone.isMade());
  // Made from the same objects that the names refer to, and made once.
  const FieldPtr half = whole->structure().operands[0];
  EXPECT_EQ(half, scene.fields[2].source->get());
  EXPECT_EQ(half->structure().operands[0], bone.get());
  EXPECT_EQ(moved.get(), whole);
  EXPECT_EQ(made, 1);
  EXPECT_FALSE(scene.fields[4].source->isMade());
}

TEST(SceneFile, WorkHandsProgressDownAndItsErrorsUp) {
  SceneRegistry registry;
  registry.fields["mesh"] = [](MapReader& reader) {
    return std::make_shared<FieldSource>("mesh " + reader.requireText("file"),
                                         [](const Progress& progress) -> FieldPtr {
                                           report(progress, "mesh", 0.5);
                                           return sphere(Vec3(0.0), 1.0);
                                         });
  };
  const auto scene =
      parseScene("palpate: 1\nlength: mm\nfields: {f: {complement: {mesh: {file: a.stl}}}}\n",
                 "test.yaml", registry);
  const FieldSource& source = *scene.fields[0].source;
  int calls = 0;
  EXPECT_THROW((void)source.get([&](std::string_view, double) {
    ++calls;
    return false;
  }),
               Error);
  EXPECT_EQ(calls, 1);
  EXPECT_FALSE(source.isMade());
  EXPECT_NO_THROW((void)source.get());  // after it was stopped once, it can be asked again
}

TEST(SceneFile, NothingMadeIsAnError) {
  const FieldSource source("mesh a.stl", [](const Progress&) { return FieldPtr(); });
  EXPECT_EQ(problemOf([&] { (void)source.get(); }).code, "field.empty");
}

TEST(SceneFile, PathsAreRelativeToTheScene) {
  const auto summary = [](const std::string& file) {
    return sceneWith("fields: {f: {mesh: {file: " + file + "}}}\n").fields[0].source->summary();
  };
  EXPECT_EQ(summary("bone.stl"), "mesh folder/bone.stl");
  EXPECT_EQ(summary("../data/bone.stl"), "mesh folder/../data/bone.stl");
  EXPECT_EQ(summary("/data/bone.stl"), "mesh /data/bone.stl");
}

TEST(SceneFile, MaterialsInTheirUnits) {
  const SceneDescription scene = sceneWith(
      "materials:\n"
      "  plain: {}\n"
      "  wall: {stiffness: 1.5 N/mm, damping: 0.5 Ns/m, friction: {static: 0.3}}\n"
      "  flow: {viscosity: 2 N.s/m, flow: [10 mm/s, -1 cm/s, 0.5 m/s]}\n");
  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_EQ(scene.materials[0].stiffness, 0.0);
  EXPECT_EQ(scene.materials[1].stiffness, 1500.0);
  EXPECT_EQ(scene.materials[1].damping, 0.5);
  EXPECT_EQ(scene.materials[1].friction.kinetic_ratio, 0.3);  // as static where not given
  EXPECT_EQ(scene.materials[2].flow, Vec3(0.01, -0.01, 0.5));
}

TEST(SceneFile, LimitsOfTheForceInTheirUnits) {
  const ForceRequest all = sceneWith("force: {max: 2500 mN, slew: 2 kN/s, ramp: 200 ms}\n").force;
  EXPECT_EQ(all, (ForceRequest{2.5, 2000.0, 0.2}));
  EXPECT_EQ(sceneWith("force: {slew: 500 mN/s}\n").force, (ForceRequest{{}, 0.5, {}}));
  EXPECT_EQ(sceneWith("").force, ForceRequest{});
}

TEST(SceneFile, WallsPortsAndTheRest) {
  const SceneDescription scene = sceneWith(
      "renderer: paper\n"
      "memory: keep\n"
      "description: |\n"
      "  several\n"
      "  lines\n"
      "start: {region: core}\n"
      "fields: {ball: {sphere: {center: [0, 0, 0], radius: 9}}}\n"
      "materials: {bone: {stiffness: 2 kN/m}}\n"
      "layers:\n"
      "  - {name: shell, inside: ball}\n"
      "  - {name: core, inside: {sphere: {center: [0, 0, 0], radius: 5}}, wall: absent}\n"
      "walls:\n"
      "  - {between: [shell, core], wall: bone, felt_from: core}\n"
      "  - {between: [\"*\", core], wall: absent}\n"
      "ports:\n"
      "  - {name: second, between: [shell, core], after: [first], direction: out, opens_at: 500 "
      "mN}\n"
      "  - {name: first, between: [\"out*\", \"?hell\"], where: ball, direction: in, back: 0 N}\n");
  EXPECT_EQ(scene.renderer, RendererKind::kPaper);
  EXPECT_TRUE(scene.keep_memory);
  EXPECT_EQ(scene.start_region, "core");
  EXPECT_EQ(scene.start_place.line, 8);
  EXPECT_EQ(scene.layers[0].wall.material, "");
  EXPECT_FALSE(scene.layers[0].wall.absent);
  EXPECT_TRUE(scene.layers[1].wall.absent);
  ASSERT_EQ(scene.walls.size(), 2U);
  EXPECT_EQ(scene.walls[0].wall.material, "bone");
  EXPECT_EQ(scene.walls[0].felt_from, "core");
  EXPECT_EQ(scene.walls[0].place.line, 15);
  EXPECT_TRUE(scene.walls[1].wall.absent);
  EXPECT_EQ(scene.walls[1].felt_from, "");
  ASSERT_EQ(scene.ports.size(), 2U);
  EXPECT_EQ(scene.ports[0].after, std::vector<AfterDescription>{"first"});
  EXPECT_EQ(scene.ports[0].direction, PortDirection::kOut);
  EXPECT_EQ(scene.ports[0].opens_at, 0.5);
  EXPECT_EQ(scene.ports[1].from, "out*");
  EXPECT_EQ(scene.ports[1].direction, PortDirection::kIn);
  EXPECT_EQ(scene.ports[1].where->get(), scene.fields[0].source->get());
  EXPECT_EQ(scene.ports[1].back, 0.0);
}

TEST(SceneFile, NamesInOtherAlphabetsAndWithSpaces) {
  const SceneDescription scene = sceneWith(
      "layers:\n"
      "  - {name: \"3rd ventricle (left)\", inside: {sphere: {center: [0, 0, 0], radius: 9}}}\n"
      "  - {name: n\xC5\x93ud, inside: {sphere: {center: [0, 0, 0], radius: 5}}}\n"
      "ports:\n"
      "  - {name: p, between: [\"3rd*\", \"n?ud\"]}\n");
  EXPECT_EQ(scene.layers[0].name, "3rd ventricle (left)");
  EXPECT_EQ(scene.ports[0].to, "n?ud");
}

TEST(SceneFile, ReadsTheFileItIsGiven) {
  const testing::TempFolder folder;
  const std::string path = folder.file("scene.yaml", kContainer);
  EXPECT_EQ(readScene(path).layers.size(), 1U);
  const Problem problem = problemOf([&] { (void)readScene(folder.path("other.yaml")); });
  EXPECT_EQ(problem.file, folder.path("other.yaml"));
}

// The project's analytic scenes are consistent: every port joins neighbors, and every region is
// reached.
TEST(SceneFile, TheProjectsScenesCompile) {
  for (const std::string name : {"container", "csg_part", "valve_tube", "sponge", "flag"}) {
    const ScenePtr scene =
        compile(readScene(test::sourceFolder() + "/data/scenes/" + name + ".yaml"));
    EXPECT_FALSE(scene->ports().empty()) << name;
    for (const Region& region : scene->regions()) {
      if (region.name != "part" && region.name != "sponge") {
        EXPECT_TRUE(region.reachable) << name << " " << region.name;
      }
    }
  }
}

TEST(SceneFile, TheProjectsScenesHoldWhatTheyShow) {
  std::map<std::string, ScenePtr> scenes;
  const auto region_in = [&](const std::string& file, double x, double y, double z) {
    ScenePtr& scene = scenes[file];
    if (!scene) scene = compile(readScene(test::sourceFolder() + "/data/scenes/" + file));
    return scene->regions()[scene->regionAt(0.001 * Vec3(x, y, z))].name;
  };
  EXPECT_EQ(region_in("container.yaml", 0, 0, 14), "liquid");
  EXPECT_EQ(region_in("container.yaml", 0, 0, 16), "outside");
  EXPECT_EQ(region_in("valve_tube.yaml", -39, 0, 0), "upstream");
  EXPECT_EQ(region_in("valve_tube.yaml", 39, 11, 0), "downstream");
  EXPECT_EQ(region_in("valve_tube.yaml", 39, 13, 0), "outside");
  EXPECT_EQ(region_in("csg_part.yaml", -22, 0, -2), "chamber");   // the hollow
  EXPECT_EQ(region_in("csg_part.yaml", -22, 0, 11), "outside");   // the hole above the grease
  EXPECT_EQ(region_in("csg_part.yaml", -22, 11, -2), "chamber");  // only the hollow is so wide
  EXPECT_EQ(region_in("csg_part.yaml", -22, 11, 9), "part");
  EXPECT_EQ(region_in("csg_part.yaml", -4, 0, 11), "outside");  // the slot
  EXPECT_EQ(region_in("csg_part.yaml", 20, 0, 11), "outside");  // the dish
  EXPECT_EQ(region_in("csg_part.yaml", 45, 0, 0), "part");      // the dome
  EXPECT_EQ(region_in("sponge.yaml", 0, 0, 0), "sponge");  // the gyroid goes through its center
  EXPECT_EQ(region_in("sponge.yaml", 3, 3, 3), "jelly");   // a pore
  EXPECT_EQ(region_in("sponge.yaml", 0, 0, 21), "outside");
  EXPECT_EQ(region_in("flag.yaml", 0, 0, -1), "water");
  EXPECT_EQ(region_in("fields.yaml", -105, 30, 5), "outside");      // the hole of the ring
  EXPECT_EQ(region_in("fields.yaml", -105, -30, 16), "hourglass");  // its waist
  EXPECT_EQ(region_in("fields.yaml", -98, -30, 16), "outside");     // beside it
  EXPECT_EQ(region_in("fields.yaml", 0, -30, 15), "outside");       // in the egg cup
  EXPECT_EQ(region_in("fields.yaml", 0, -30, -2), "egg cup");       // its bottom
  EXPECT_EQ(region_in("fields.yaml", 105, -30, 9), "little heart");
}

TEST(SceneFile, EverySceneOfTheProjectIsRead) {
  int read = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::sourceFolder() + "/data/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_NO_THROW((void)readScene(entry.path().string(), standInReaders())) << entry.path();
    ++read;
  }
  EXPECT_GE(read, 3);
}

}  // namespace
}  // namespace palpate
