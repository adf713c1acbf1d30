// `baked` in scene files: what is made when, notes, ports on its faces, and places of errors.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <random>

#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "palpate/interior/partition.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/register.h"
#include "support/temp_file.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;

class SceneBaked : public ::testing::Test {
 protected:
  SceneBaked() {
    RegisterOptions options;
    options.on_grid = [this](const GridRecord& record) { grids_.push_back(record); };
    options.on_note = [this](const std::string& note) { notes_ += note + "\n"; };
    registerKinds(registry_, options);
  }

  SceneDescription read(const std::string& body) {
    return parseScene("palpate: 1\nlength: mm\nfields:\n" + body, "test.yaml", registry_);
  }

  /// Expects an error of `code` at a line and column of the scene, with the text `says`; on
  /// reading, or when the field is made.
  void expectError(const std::string& body, const std::string& code, int line, int column,
                   const std::string& says) {
    try {
      const SceneDescription scene = read(body);
      for (const NamedField& field : scene.fields) (void)field.source->get();
      (void)compile(scene);
      ADD_FAILURE() << "read without complaint:\n" << body;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_EQ(error.problem().code, code) << error.what();
      EXPECT_EQ(error.problem().file, "test.yaml") << error.what();
      EXPECT_EQ(error.problem().line, line) << error.what();
      EXPECT_EQ(error.problem().column, column) << error.what();
      EXPECT_NE((std::string(error.what()) + error.problem().hint).find(says), std::string::npos)
          << error.what() << "\n"
          << error.problem().hint;
    }
  }

  std::vector<GridRecord> grids_;
  std::string notes_;
  SceneRegistry registry_;
};

const std::string kBlock = "  block: {box: {center: [0, 0, 0], size: [20, 20, 20]}}\n";
const std::string kWave = "  wave: {gyroid: {center: [0, 0, 0], period: 20}}\n";

TEST_F(SceneBaked, PartsAreMadeWhenAskedForAndToldOf) {
  const SceneDescription scene = read(
      "  foam: {baked: {field: cut, voxel: 0.5, parts: operands}}\n"
      "  cut: {intersection: [block, wave]}\n" +
      kBlock + kWave);
  const FieldSourcePtr foam = scene.fields[0].source;
  EXPECT_FALSE(foam->isMade());
  EXPECT_TRUE(grids_.empty());
  const FieldPtr field = foam->get();
  ASSERT_EQ(grids_.size(), 1U);
  EXPECT_EQ(grids_[0].what, "baked field in line 4, part 2");
  EXPECT_EQ(grids_[0].info.name, "baked/2");
  EXPECT_EQ(grids_[0].info.length_unit, "mm");
  EXPECT_NEAR(grids_[0].info.voxel_size, 0.5 * kMm, 1e-15);
  EXPECT_NE(notes_.find("line 4, part 1 stays analytic: it has edges"), std::string::npos)
      << notes_;
  EXPECT_NE(notes_.find("line 4, part 2 is a grid, off by at most"), std::string::npos) << notes_;
  ASSERT_EQ(field->structure().kind, FieldStructure::Kind::kIntersection);
  EXPECT_EQ(field->structure().operands[0], scene.fields[2].source->get());
  EXPECT_DOUBLE_EQ(field->value(Vec3(13, 0, 0) * kMm), 3 * kMm);
}

TEST_F(SceneBaked, WithoutAVoxelSizeTheLongestSideHasAHundredAndTwentyEight) {
  const SceneDescription scene = read("  b: {baked: {field: block, parts: whole}}\n" + kBlock);
  (void)scene.fields[0].source->get();
  ASSERT_EQ(grids_.size(), 1U);
  EXPECT_NEAR(grids_[0].info.voxel_size, 20 * kMm / 128, 1e-12);
  EXPECT_EQ(grids_[0].info.name, "baked");
  EXPECT_NE(notes_.find("one grid of the whole was asked for; it is off by at most"),
            std::string::npos)
      << notes_;
}

TEST_F(SceneBaked, APortIsOnWhatStayedAnalyticOrOnTheWhole) {
  const std::string fields =
      "  foam: {baked: {field: {intersection: [block, wave]}, voxel: 0.5, "
      "parts: operands}}\n" +
      kBlock + kWave + "layers: [{name: a, inside: foam}]\n";
  const auto port = [&](const std::string& on) {
    return fields + "ports: [{name: p, between: [outside, a], on: " + on + "}]\n";
  };
  EXPECT_NO_THROW((void)compile(read(port("block"))));
  EXPECT_NO_THROW((void)compile(read(port("foam"))));
  expectError(port("wave"), "scene.port_face", 8, 16, "'wave' is part of the baked in line 4");
}

TEST_F(SceneBaked, ErrorsPointAtWhatIsWrong) {
  const auto baked = [](const std::string& keys) {
    return "  b: {baked: {field: block, " + keys + "}}\n" + kBlock;
  };
  expectError(baked("voxel: 0"), "scene.range", 4, 36, "more than 0");
  expectError(baked("voxel: -1"), "scene.range", 4, 36, "more than 0");
  expectError(baked("half_width: 1"), "scene.range", 4, 41, "2 voxels or more");
  expectError(baked("tolerance: 0"), "scene.range", 4, 40, "more than 0");
  expectError(baked("parts: operand"), "scene.kind", 4, 36, "parts: operands");
  expectError(baked("parts: all"), "scene.kind", 4, 36, "parts: whole");
  expectError(baked("sampler: linear"), "scene.kind", 4, 38, "trilinear");
  expectError(baked("parts: whole, tolerance: 1"), "scene.range", 4, 54, "leave out tolerance");
  expectError(baked("voxels: 1"), "scene.unknown_key", 4, 29, "voxel");
  expectError("  b: {baked: {voxel: 1}}\n", "scene.missing_key", 4, 14, "field");
  expectError("  b: {baked: {field: nothing}}\n", "scene.unknown_field", 4, 22, "nothing");
  expectError("  b: {baked: {field: b}}\n", "scene.cycle", 4, 22, "b -> b");
  // Only known when it is made.
  expectError("  b: {baked: {field: wave}}\n" + kWave, "bake.unbounded", 4, 14, "voxel");
  expectError("  b: {baked: {field: wave, voxel: 1, parts: whole}}\n" + kWave, "bake.unbounded", 4,
              14, "analytic");
}

TEST_F(SceneBaked, GridsOfAFileTakeTheirPlaces) {
  const palpate::testing::TempFolder folder;
  const std::string foam = "{intersection: [block, wave]}";
  HybridOptions options;
  options.bake = test::voxels(0.5 * kMm);
  options.bake.name = "foam/surface";
  options.parts = Parts::kOperands;
  const auto field = [&](const std::string& body) {
    return readScene(folder.file("s.yaml", "palpate: 1\nlength: mm\nfields:\n" + body), registry_)
        .fields[0]
        .source->get();
  };
  const Hybrid hybrid = bakeHybrid(field("  foam: " + foam + "\n" + kBlock + kWave), options);
  std::vector<LevelSet> grids;
  for (const HybridPart& part : hybrid.parts) {
    if (part.grid) grids.push_back(part.grid);
  }
  writeVdb(folder.path("g.vdb"), grids, true);
  const auto saved = [&](const std::string& keys) {
    return "  b: {baked: {field: " + foam + ", file: g.vdb" + keys + "}}\n" + kBlock + kWave;
  };
  grids_.clear();
  const FieldPtr made = field(saved(", name: foam/surface"));
  ASSERT_EQ(grids_.size(), 1U);
  EXPECT_EQ(grids_[0].what, "baked field in line 4, part 2");
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = Vec3(11.0 * std::sin(1.7 * i), 11.0 * std::sin(2.3 * i), 0.03 * i - 7) * kMm;
    // Voxels are written as floats in mm, and read back unchanged.
    EXPECT_EQ(made->value(p), hybrid.field->value(p));
  }
  const auto expect_refused = [&](const std::string& body, const std::string& code,
                                  const std::string& says) {
    try {
      (void)field(body);
      ADD_FAILURE() << "read without complaint:\n" << body;
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, code) << error.what();
      EXPECT_EQ(error.problem().line, 4) << error.what();
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  };
  expect_refused(saved(""), "bake.no_parts", "baked");
  expect_refused(saved(", name: foam/surface, voxel: 1"), "scene.range", "leave out voxel");
  expect_refused("  b: {baked: {field: block, file: no.vdb}}\n" + kBlock, "scene.no_file",
                 "no.vdb");
  expect_refused("  b: {baked: {field: block, file: g.vdb, name: foam/surface}}\n" + kBlock,
                 "bake.other_field", "bake again");
}

TEST_F(SceneBaked, WhatIsDamagedInAFileIsRebuiltAndToldOrRefused) {
  const palpate::testing::TempFolder folder;
  HybridOptions options;
  options.bake = test::voxels(0.5 * kMm, kCubicHalfWidth);
  options.bake.name = "b";
  options.parts = Parts::kWhole;
  const std::string ball = "  ball: {sphere: {center: [0, 0, 0], radius: 9}}\n";
  const LevelSet whole = bakeHybrid(sphere(Vec3(0.0), 9 * kMm), options).parts[0].grid;
  const auto made = [&](const LevelSet& grid) {
    const std::vector<LevelSet> one{grid};
    writeVdb(folder.path("g.vdb"), one, true);
    const std::string body = "  b: {baked: {field: ball, file: g.vdb, name: b}}\n" + ball;
    return readScene(folder.file("s.yaml", "palpate: 1\nlength: mm\nfields:\n" + body), registry_)
        .fields[0]
        .source->get();
  };
  (void)made(whole);
  EXPECT_EQ(notes_, "");
  const auto damaged = [&](const openvdb::Coord& at, const auto& change) {
    const openvdb::FloatGrid::Ptr copy = whole.impl().grid->deepCopy();
    auto accessor = copy->getAccessor();
    change(accessor, at);
    return makeLevelSet(copy, "mm", whole.info().metadata);
  };
  // The value four voxels outside becomes 2.2.
  (void)made(damaged(
      {22, 0, 0}, [](auto& accessor, const openvdb::Coord& at) { accessor.setValueOn(at, 1.1F); }));
  EXPECT_NE(notes_.find("rebuilt"), std::string::npos) << notes_;
  EXPECT_NE(notes_.find("(11, 0, 0) mm"), std::string::npos) << notes_;
  try {
    (void)made(damaged({18, 0, 0}, [](auto& accessor, const openvdb::Coord& at) {
      accessor.setValueOff(at, 3.0F);
    }));
    ADD_FAILURE() << "a torn grid is taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "vdb.torn") << error.what();
    EXPECT_EQ(error.problem().line, 4) << error.what();
  }
}

TEST_F(SceneBaked, FieldsInItCountAsNested) {
  std::string body = "  f0: {sphere: {center: [0, 0, 0], radius: 1}}\n";
  for (int i = 1; i < 70; ++i) {
    const std::string before = "f" + std::to_string(i - 1);
    body += "  f" + std::to_string(i) + ": {baked: {field: " + before + ", voxel: 1}}\n";
  }
  try {
    (void)read(body);
    ADD_FAILURE() << "read without complaint";
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "scene.depth") << error.what();
  }
}

// The part of a grid that the device cannot reach is not made; within reach there is no difference.
TEST_F(SceneBaked, BeyondTheWorkspaceNoGridIsMade) {
  const std::string scene =
      "  ring: {torus: {center: [0, 0, 0], axis: [0, 0, 1], radius: 20, tube: 8}}\n"
      "  turned: {transform: {field: ring, translate: [60, 0, 0], rotate: {axis: [1, 0, 0], "
      "degrees: 40}}}\n"
      "layers:\n"
      "  - {name: ring, inside: {baked: {field: {union: [ring, {cone: {base: [0, 0, -30], axis: "
      "[0, 0, 1], "
      "radius: 20, height: 20}}]}, voxel: 1, parts: operands}}}\n"
      "  - {name: turned, inside: {baked: {field: turned, voxel: 1, parts: whole}}}\n"
      "device: {workspace: {box: {center: [20, 10, 0], size: [30, 20, 40]}}}\n";
  const auto bytes_of = [](const Scene& made) {
    std::uint64_t bytes = 0;
    for (const Leaf& leaf : made.partition().leaves()) bytes += memoryOf(*leaf.field);
    return bytes;
  };
  const ScenePtr felt = compile(read(scene));
  const ScenePtr all = compile(read(scene), {}, Purpose::kShow);
  EXPECT_LT(bytes_of(*felt), bytes_of(*all) / 2);
  EXPECT_GT(bytes_of(*felt), 0U);
  const Box3 reach = felt->device().reach();
  const auto a = makeRenderer(felt);
  const auto b = makeRenderer(all);
  int touched = 0;
  bool is_lost = false;
  for (int i = 0; i < 60000; ++i) {
    const double t = 0.001 * i;
    const Vec3 wave(std::sin(3.1 * t), std::cos(2.3 * t), std::sin(1.7 * t + 1.0));
    // Also on the border of the workspace, but no deeper in a wall than the margin kept beyond it:
    // 2.7 mm.
    const HipState hip{glm::clamp(reach.center() + 0.6 * reach.size() * wave, reach.lo, reach.hi),
                       Vec3(0.0)};
    if (is_lost && all->regionAt(hip.position) == kOutside) {
      a->reset();
      b->reset();
      is_lost = false;
    }
    const TickResult two = b->update(hip);
    is_lost = is_lost || glm::distance(two.proxy, hip.position) > 2.6 * kMm;
    if (is_lost) continue;
    const TickResult one = a->update(hip);
    ASSERT_EQ(one.region, two.region) << i;
    ASSERT_EQ(one.contact, two.contact) << i;
    // The steepest slope of the existing bricks limits all steps: the proxy stops at another place
    // within its tolerance of 1e-9 voxels, and the difference grows with each slide.
    ASSERT_LT(glm::distance(one.proxy, two.proxy), 1e-8 * kMm) << i;
    touched += one.contact ? 1 : 0;
  }
  EXPECT_GT(touched, 1000);
}

TEST(GridField, OfAPartIsThatOfTheWholeAndKeepsItsSignBeyond) {
  const LevelSet grid = bake(*torus(Vec3(0.0), Vec3(0, 0, 1), 0.02, 0.008), {.voxel_size = kMm});
  const Box3 within{Vec3(0.005, -0.012, -0.02), Vec3(0.04, 0.003, 0.004)};
  for (const Sampler sampler : {Sampler::kCubic, Sampler::kTrilinear}) {
    const FieldPtr whole = gridField(grid, sampler);
    const FieldPtr part = gridField(grid, sampler, within);
    EXPECT_LT(memoryOf(*part), memoryOf(*whole) / 3);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 20000; ++i) {
      const Vec3 share(unit(random), unit(random), unit(random));
      const Vec3 p = within.lo + share * within.size();
      const FieldSample one = part->sample(p);
      const FieldSample two = whole->sample(p);
      ASSERT_EQ(one.in_band, two.in_band) << i;
      // Positions are relative to another corner, and are rounded accordingly.
      ASSERT_LT(glm::distance(one.gradient, two.gradient), 1e-12) << i;
      if (two.in_band) {
        ASSERT_NEAR(one.value, two.value, 1e-12 * kMm) << i;
      } else {
        // The bound is that of the existing bricks.
        ASSERT_EQ(one.value < 0.0, two.value < 0.0) << i;
        ASSERT_GE(std::fabs(one.value), (1.0 - 1e-12) * std::fabs(two.value)) << i;
      }
      const Vec3 far = -0.06 + 0.12 * share;
      ASSERT_EQ(part->value(far), part->value(glm::clamp(far, within.lo, within.hi))) << i;
    }
  }
}

}  // namespace
}  // namespace palpate::vdb
