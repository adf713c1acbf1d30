// The properties of a grid that contact relies on: checked, stored with the grid, and required of
// every grid that is touched.

#include "palpate/vdb/certificate.h"

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/grid_check.h"
#include "palpate/vdb/grid_memory.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/register.h"
#include "support/error_of.h"
#include "support/temp_file.h"
#include "vdb/certificate_judge.h"
#include "vdb/foreign_grids.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using palpate::test::Drive;
using palpate::test::kDefaultK;
using palpate::testing::TempFolder;
using test::voxels;

constexpr double kMm = 1e-3;

CertifyOptions own(Sampler sampler = Sampler::kCubic) {
  CertifyOptions options;
  options.sampler = sampler;
  options.is_foreign = false;
  return options;
}

std::vector<std::pair<std::string, FieldPtr>> shapes() {
  return {{"ball", sphere(Vec3(0.3 * kMm), 12 * kMm)},
          {"ring", torus(Vec3(0.1 * kMm), Vec3(1, 2, 3), 14 * kMm, 6 * kMm)},
          {"box", box(Vec3(0.2 * kMm), Vec3(17.3 * kMm, 21.1 * kMm, 12.7 * kMm))},
          {"wedge",
           intersect({halfSpace(Vec3(0.0), Vec3(0.3, 1, 0)), halfSpace(Vec3(0.0), Vec3(0.3, -1, 0)),
                      box(Vec3(-10 * kMm, 0, 0), Vec3(20 * kMm))})},
          {"heart", heart(Vec3(0.0), 40 * kMm)}};
}

// The bounds compared with many samples: none is outside them.
TEST(Certificate, BoundsHoldWhereverTheGridIsSampled) {
  for (const auto& [name, field] : shapes()) {
    for (const Sampler sampler : {Sampler::kCubic, Sampler::kTrilinear}) {
      SCOPED_TRACE(name);
      const double voxel = 1 * kMm;
      const LevelSet grid = bake(*field, voxels(voxel, kCubicHalfWidth));
      test::expectBoundsHold(name, grid, sampler, field->bounds().grownBy(4 * voxel));
    }
  }
}

TEST(Certificate, ASmoothShapeHasNoRoughCellAndABoxHas) {
  const auto rough = [](const FieldPtr& field) {
    return certified(bake(*field, voxels(1 * kMm, kCubicHalfWidth)), own()).certificate.rough;
  };
  EXPECT_EQ(rough(sphere(Vec3(0.0), 12 * kMm)), 0.0);
  EXPECT_GT(rough(box(Vec3(0.2 * kMm), Vec3(17.3 * kMm))), 0.0);
}

TEST(Certificate, IsKeptWithTheGridUnderAHashOfItsContent) {
  const TempFolder folder;
  const LevelSet grid = certified(bake(*sphere(Vec3(0.0), 9 * kMm), voxels(1 * kMm)), own()).grid;
  const std::vector<LevelSet> one{grid};
  writeVdb(folder.path("ball.vdb"), one, false);
  const LevelSet read = readVdb(folder.path("ball.vdb"), "", "");
  ASSERT_EQ(contentHash(read), contentHash(grid));
  const auto stored = storedCertificate(read);
  ASSERT_TRUE(stored);
  EXPECT_NEAR(stored->within, certified(grid, own()).certificate.within, 1e-12);
  EXPECT_FALSE(storedCertificate(read, Sampler::kTrilinear)) << "it is of the other sampler";
  // Independent of its name, and of other metadata.
  EXPECT_EQ(contentHash(read.named("other", {{"layer", "x"}})), contentHash(grid));
  // If one voxel differs in the last bit of a float, the hash differs.
  const openvdb::FloatGrid::Ptr copy = read.impl().grid->deepCopy();
  auto voxel = copy->beginValueOn();
  voxel.setValue(std::nextafter(*voxel, 100.0F));
  EXPECT_FALSE(storedCertificate(makeLevelSet(copy, "mm")));
  // The hash also differs if a voxel is missing.
  const openvdb::FloatGrid::Ptr less = read.impl().grid->deepCopy();
  less->beginValueOn().setValueOff();
  EXPECT_FALSE(storedCertificate(makeLevelSet(less, "mm")));
}

TEST(Certificate, ContentHashesTellPlaceUnitAndSide) {
  const LevelSet grid = bake(*sphere(Vec3(0.0), 9 * kMm), voxels(1 * kMm));
  const openvdb::FloatGrid::Ptr moved = grid.impl().grid->deepCopy();
  moved->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
  moved->transform().postTranslate(openvdb::Vec3d(1e-9, 0.0, 0.0));
  EXPECT_NE(contentHash(makeLevelSet(moved, "mm")), contentHash(grid));
  EXPECT_NE(contentHash(makeLevelSet(grid.impl().grid->deepCopy(), "cm")), contentHash(grid));
  const openvdb::FloatGrid::Ptr turned = grid.impl().grid->deepCopy();
  for (auto value = turned->beginValueOff(); value; ++value) value.setValue(turned->background());
  EXPECT_NE(contentHash(makeLevelSet(turned, "mm")), contentHash(grid));
}

/// What becomes of another tool's grid: by `check`, or in a scene that touches it.
struct Verdict {
  bool is_yes = false;
  std::string code;  ///< reason of the refusal
  std::vector<std::string> notes;
  double off = 0.0;  ///< [m] as stated
  ScenePtr scene;
};

Verdict checkOf(const std::string& path) {
  Verdict out;
  try {
    const GridCheck check = checkVdb(path).at(0);
    out.is_yes = !check.refused && !check.uncertified;
    if (check.refused) out.code = check.refused->code;
    if (check.uncertified) out.code = check.uncertified->code;
    out.notes = check.repairs;
    if (check.certificate) out.off = check.certificate->off;
  } catch (const Error& error) {
    out.code = error.problem().code;
  }
  return out;
}

Verdict sceneOf(const std::string& path, const RegisterOptions& given = {}) {
  Verdict out;
  SceneRegistry registry;
  RegisterOptions options = given;
  options.on_note = [&](const std::string& note) { out.notes.push_back(note); };
  registerKinds(registry, options);
  try {
    out.scene =
        compile(parseScene("palpate: 1\nlength: mm\nlayers:\n  - {name: solid, inside: "
                           "{grid: {file: \"" +
                               path + "\"}}}\n",
                           "test.yaml", registry));
    out.is_yes = true;
  } catch (const Error& error) {
    out.code = error.problem().code;
  }
  return out;
}

/// Descends along the gradient of an exact field to the surface.
Vec3 onSurface(const Field& truth, const Vec3& p) {
  const FieldSample s = truth.sample(p);
  return p - s.value * s.gradient;
}

/// Whether the truth is smooth over some voxels: the gradient around the point turns no more than
/// for a ball of eight voxels.
bool isSmooth(const Field& truth, const Vec3& p, double voxel) {
  const Vec3 here = truth.sample(p).gradient;
  palpate::test::Random random(1);
  for (int i = 0; i < 40; ++i) {
    const Vec3 there = p + 4.0 * voxel * random.direction();
    if (glm::dot(truth.sample(there).gradient, here) < 0.6) return false;
  }
  return true;
}

// 200 grids: a scene does as `check` says, and a grid that is touched without a note is felt within
// its stated error.
TEST(Certificate, CheckAndTouchAgreeOnTwoHundredGrids) {
  const TempFolder folder;
  int whole_refused = 0;
  int touched = 0, noted = 0, refused = 0, disagree = 0;
  std::map<std::string, int> why;
  double worst = 0.0;  // largest force error, relative to the stated error
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const test::ForeignGrid foreign = test::foreignGrid(seed);
    SCOPED_TRACE(std::to_string(seed) + ": " + foreign.how);
    const std::string path = folder.path("grid.vdb");
    test::writeAsOthers(path, foreign.grid);
    const Verdict check = checkOf(path);
    const Verdict scene = sceneOf(path);
    disagree += check.is_yes != scene.is_yes ? 1 : 0;
    EXPECT_EQ(check.is_yes, scene.is_yes) << check.code << " " << scene.code;
    EXPECT_EQ(check.code, scene.code);
    if (!foreign.is_damaged) {
      whole_refused += check.is_yes ? 0 : 1;
      if (check.is_yes) {
        EXPECT_TRUE(check.notes.empty()) << check.notes.front();
      }
    }
    if (!scene.is_yes || !check.is_yes) {
      ++refused;
      ++why[scene.code];
      continue;
    }
    if (!check.notes.empty()) {
      ++noted;
      continue;
    }
    ++touched;
    const double voxel = foreign.grid->voxelSize().x() * kMm;
    const double depth = 0.7 * voxel;
    palpate::test::Random random(seed);
    for (int i = 0; i < 24; ++i) {
      // Half of the points are near the damage, if there is any.
      const Vec3 from = foreign.is_damaged && i % 2 == 0
                            ? foreign.damage + 2.0 * voxel * random.direction()
                            : random.in(foreign.truth->bounds());
      const Vec3 on = onSurface(*foreign.truth, from);
      if (std::fabs(foreign.truth->value(on)) > 1e-9 || !isSmooth(*foreign.truth, on, voxel))
        continue;
      const Vec3 normal = foreign.truth->sample(on).gradient;
      const Vec3 hip = on - depth * normal;
      Drive drive(scene.scene);
      (void)drive.to(on + 2.0 * voxel * normal);
      (void)drive.walk(hip);
      TickResult tick;
      for (int n = 0; n < 10; ++n) tick = drive.to(hip);
      const double error = std::fabs(glm::length(tick.force) - kDefaultK * depth);
      worst = std::max(worst, error / (kDefaultK * check.off));
      EXPECT_LE(error, kDefaultK * check.off) << i << ": " << glm::length(tick.force) << " N";
    }
  }
  std::printf(
      "200 grids: %d touched without a note, %d repaired and told, %d refused, %d disagree; force "
      "off by at most %.2f of the stated error\n",
      touched, noted, refused, disagree, worst);
  for (const auto& [code, count] : why) std::printf("  %s: %d\n", code.c_str(), count);
  EXPECT_GE(touched, 100);
  EXPECT_GE(refused, 20);
  EXPECT_EQ(whole_refused, 0);
}

openvdb::FloatGrid::Ptr sphereOfOthers(double half_width, float radius = 10.0F) {
  openvdb::initialize();
  const auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
      radius, openvdb::Vec3f(0.3F, 0.1F, -0.2F), 1.0F, static_cast<float>(half_width));
  grid->setName("ball");
  return grid;
}

TEST(Certificate, ATornBandIsNotTouched) {
  // A hole of a few voxels in the band of a sphere: before, the force there was 14 N instead of 1
  // N.
  const TempFolder folder;
  for (const bool to_inside : {false, true}) {
    const auto grid = sphereOfOthers(3.0);
    auto accessor = grid->getAccessor();
    for (int x = 7; x <= 13; ++x) {
      for (int y = -2; y <= 2; ++y) {
        for (int z = -2; z <= 2; ++z) {
          accessor.setValueOff({x, y, z}, to_inside ? -grid->background() : grid->background());
        }
      }
    }
    const std::string path = folder.path("torn.vdb");
    test::writeAsOthers(path, grid);
    const Verdict scene = sceneOf(path);
    EXPECT_FALSE(scene.is_yes);
    EXPECT_EQ(scene.code, "vdb.torn");
    EXPECT_EQ(checkOf(path).code, "vdb.torn");
  }
}

TEST(Certificate, WrongValuesAwayFromTheSurfaceAreRebuiltAndTold) {
  const TempFolder folder;
  const auto grid = sphereOfOthers(6.0);
  auto accessor = grid->getAccessor();
  for (int x = 13; x <= 15; ++x) accessor.setValueOn({x, 0, 0}, 2.4F);
  const std::string path = folder.path("wrong.vdb");
  test::writeAsOthers(path, grid);
  const Verdict scene = sceneOf(path);
  ASSERT_TRUE(scene.is_yes) << scene.code;
  ASSERT_EQ(scene.notes.size(), 1U);
  EXPECT_NE(scene.notes[0].find("rebuilt"), std::string::npos) << scene.notes[0];
  EXPECT_NE(scene.notes[0].find(" mm"), std::string::npos) << "it names a place";
  EXPECT_EQ(checkOf(path).notes.size(), 1U);
  // The distances are those of the sphere again.
  const Field& field = *scene.scene->regions()[1].field;
  for (int i = 0; i < 60; ++i) {
    const Vec3 p = Vec3(0.3, 0.1, -0.2) * kMm + Vec3((9.0 + 0.05 * i) * kMm, 0.0, 0.0);
    const FieldSample s = field.sample(p);
    if (!s.in_band) continue;
    EXPECT_NEAR(s.value, (-1.0 + 0.05 * i) * kMm, 0.02 * kMm);
  }
  // The bound from the spline's coefficients at the band's rim, where prefiltered ones are beside
  // plain ones; with one wrong coefficient it would be three times as steep.
  EXPECT_LE(field.lipschitz(), 1.75);
}

TEST(Certificate, OutOfTheBandInContactTheForceHoldsOrFalls) {
  // A hand pushed from the surface to the middle of a ball whose band ends 6 voxels deep, and back:
  // on the way the force is that of the depth or less, never more.
  const TempFolder folder;
  const std::string path = folder.path("ball.vdb");
  test::writeAsOthers(path, sphereOfOthers(3.0));
  const Verdict scene = sceneOf(path);
  ASSERT_TRUE(scene.is_yes) << scene.code;
  const Vec3 center = Vec3(0.3, 0.1, -0.2) * kMm;
  palpate::test::Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Vec3 u = random.direction();
    Drive drive(scene.scene);
    (void)drive.to(center + 14 * kMm * u);
    for (double r = 12.0; r > 0.3; r -= 0.1) {
      const double force = glm::length(drive.to(center + r * kMm * u).force);
      ASSERT_LE(force, kDefaultK * (std::max(0.0, 10.0 - r) + 0.02) * kMm) << r;
    }
  }
}

TEST(Certificate, MemoryForBricksAndForLoadingIsBounded) {
  const TempFolder folder;
  const LevelSet grid = bake(*sphere(Vec3(0.0), 40 * kMm), voxels(1 * kMm));
  const std::vector<LevelSet> one{grid};
  writeVdb(folder.path("ball.vdb"), one, false);
  const std::uint64_t bytes = grid.info().memory;
  const auto code = [](const auto& make) { return errorOf(make).problem().code; };
  // Bricks take about three times the memory of the grid.
  EXPECT_EQ(code([&] {
              static_cast<void>(gridField(grid, Sampler::kCubic, Box3::everything(), 2 * bytes));
            }),
            "bricks.memory");
  EXPECT_TRUE(gridField(grid, Sampler::kCubic, Box3::everything(), 8 * bytes));
  EXPECT_EQ(code([&] {
              static_cast<void>(
                  readVdb(folder.path("ball.vdb"), "", "", UnknownClass::kRefuse, bytes / 2));
            }),
            "vdb.memory");
  EXPECT_TRUE(readVdb(folder.path("ball.vdb"), "", "", UnknownClass::kRefuse, 2 * bytes));
  RegisterOptions options;
  options.max_memory = 2 * bytes;
  EXPECT_EQ(sceneOf(folder.path("ball.vdb"), options).code, "bricks.memory");
}

TEST(Certificate, WhatWasWidenedIsKept) {
  const TempFolder folder;
  const std::string path = folder.path("ball.vdb");
  test::writeAsOthers(path, sphereOfOthers(3.0, 60.0F));
  RegisterOptions options;
  options.cache_folder = folder.path("cache");
  const Verdict first = sceneOf(path, options);
  ASSERT_TRUE(first.is_yes) << first.code;
  const auto files = [&] {
    std::vector<std::filesystem::path> all;
    for (const auto& entry : std::filesystem::directory_iterator(options.cache_folder)) {
      all.push_back(entry.path());
    }
    return all;
  };
  ASSERT_EQ(files().size(), 1U);
  const auto about = std::filesystem::status(options.cache_folder).permissions();
  EXPECT_EQ(about & (std::filesystem::perms::group_all | std::filesystem::perms::others_all),
            std::filesystem::perms::none);
  // Read back, the certificate says the same as when it was made.
  const Verdict second = sceneOf(path, options);
  ASSERT_TRUE(second.is_yes);
  EXPECT_EQ(second.notes, first.notes);
  const Field& a = *first.scene->regions()[1].field;
  const Field& b = *second.scene->regions()[1].field;
  palpate::test::Random random(9);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = 60 * kMm * random.direction() + 2 * kMm * random.direction();
    ASSERT_EQ(a.sample(p).value, b.sample(p).value);
  }
  // Metadata show where the grid came from: a damaged grid in the cache is not used.
  const std::filesystem::path kept = files().front();
  {
    const LevelSet grid = readVdb(kept.string(), "", "");
    const openvdb::FloatGrid::Ptr copy = grid.impl().grid->deepCopy();
    for (auto value = copy->beginValueOn(); value; ++value) value.setValue(*value + 0.4F);
    const std::vector<LevelSet> one{makeLevelSet(copy, "mm", grid.info().metadata)};
    writeVdb(kept.string(), one, true);
  }
  const Verdict third = sceneOf(path, options);
  ASSERT_TRUE(third.is_yes);
  EXPECT_EQ(third.scene->regions()[1].field->sample(Vec3(60 * kMm, 0, 0)).value,
            a.sample(Vec3(60 * kMm, 0, 0)).value);
}

}  // namespace
}  // namespace palpate::vdb
