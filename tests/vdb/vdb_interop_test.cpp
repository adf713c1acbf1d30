// .vdb files of other tools: files written by python3-openvdb and OpenVDB are read correctly, or
// refused with a reason and a remedy; files written here are read by vdb_print and vdb_render.

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "folders/folders.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/grid_check.h"
#include "palpate/vdb/grid_image.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/register.h"
#include "support/error_of.h"
#include "support/scan_folder.h"
#include "support/temp_file.h"

namespace palpate::vdb {
namespace {

using palpate::testing::TempFolder;

const Vec3 kCenter(1e-3, 2e-3, 3e-3);
constexpr double kRadius = 6e-3;
constexpr double kVolume = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;

/// The files that vdb_interop.py writes, once for all tests here.
class VdbOfOthers : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    home = new TempFolder;
    const std::string command = "/usr/bin/python3 '" + palpate::test::sourceFolder() +
                                "/tests/vdb/vdb_interop.py' '" + home->path() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
  }
  static void TearDownTestSuite() {
    delete home;
    home = nullptr;
  }
  static std::string path(const std::string& name) { return home->path(name + ".vdb"); }
  static Problem refusal(const std::string& name) {
    return errorOf([&] { static_cast<void>(readVdb(path(name), "", "")); }).problem();
  }
  static GridCheck checked(const std::string& name, const std::string& unit = "") {
    const auto checks = checkVdb(path(name), "", unit);
    EXPECT_EQ(checks.size(), 1U);
    return checks.at(0);
  }

 private:
  static TempFolder* home;
};
TempFolder* VdbOfOthers::home = nullptr;

void expectBall(const LevelSet& set, double tolerance) {
  const FieldPtr field = gridField(set);
  for (const Vec3& u : {Vec3(1, 0, 0), Vec3(0, -0.6, 0.8), Vec3(0.48, 0.6, 0.64)}) {
    for (const double depth : {-0.5e-3, 0.0, 0.4e-3}) {
      const FieldSample sample = field->sample(kCenter + (kRadius + depth) * u);
      EXPECT_TRUE(sample.in_band);
      EXPECT_NEAR(sample.value, depth, tolerance);
      EXPECT_NEAR(glm::distance(sample.gradient, u), 0.0, 0.02);
    }
  }
  EXPECT_LT(field->value(kCenter), 0.0);
  EXPECT_GT(field->value(kCenter + Vec3(0.02, 0.0, 0.0)), 0.0);
}

TEST_F(VdbOfOthers, LevelSetsOfPythonAreRead) {
  // A thousandth of the voxel for floats; half floats keep 11 bits of up to 1.5 mm.
  expectBall(readVdb(path("ball"), "", ""), 0.5e-6);
  expectBall(readVdb(path("half"), "ball", ""), 1e-6);
  expectBall(readVdb(path("no_unit"), "", "mm"), 0.5e-6);
  expectBall(readVdb(path("no_class"), "", "", UnknownClass::kLevelSet), 0.5e-6);
}

TEST_F(VdbOfOthers, ASceneSaysTheClassOfAGridWithoutOne) {
  SceneRegistry registry;
  registerKinds(registry);
  const TempFolder folder;
  const auto read = [&](const std::string& more) {
    return readScene(folder.file("scene.yaml",
                                 "palpate: 1\nlength: mm\nlayers:\n  - {name: a, inside: {grid: "
                                 "{file: \"" +
                                     path("no_class") + "\"" + more + "}}}\n"),
                     registry);
  };
  const FieldPtr field = read(", class: level_set").layers.at(0).inside->get();
  EXPECT_NEAR(field->value(kCenter + Vec3(0.0, kRadius, 0.0)), 0.0, 0.5e-6);
  const SceneDescription without = read("");
  Error error = errorOf([&] { static_cast<void>(without.layers.at(0).inside->get()); });
  EXPECT_EQ(error.problem().code, "vdb.class");
  EXPECT_NE(error.problem().hint.find("class: level_set"), std::string::npos);
  error = errorOf([&] { static_cast<void>(read(", class: fog")); });
  EXPECT_NE(error.problem().hint.find("level_set"), std::string::npos);
}

TEST_F(VdbOfOthers, TheRestIsRefusedWithWhatHelps) {
  const struct {
    const char* name;
    const char* code;
    const char* hint;
  } cases[] = {
      {"no_class", "vdb.class", "--level-set"},
      {"no_unit", "vdb.no_unit", "unit"},
      {"fog", "vdb.class", "--above"},
      {"mask", "vdb.type", "--above"},
      {"vectors", "vdb.type", "vector"},
      {"turned", "vdb.transform", "palpate convert"},
      {"mirrored", "vdb.transform", "convert"},
      {"stretched", "vdb.transform", "--voxel"},
      {"empty", "vdb.empty", ""},
  };
  for (const auto& c : cases) {
    const Problem problem = refusal(c.name);
    EXPECT_EQ(problem.code, c.code) << c.name;
    EXPECT_NE(problem.hint.find(c.hint), std::string::npos) << c.name << ": " << problem.hint;
    EXPECT_EQ(problem.file, path(c.name));
    const GridCheck check = checked(c.name);
    ASSERT_TRUE(check.refused) << c.name;
    EXPECT_EQ(check.refused->code, c.code);
  }
  // A class stated in the file is not overridden.
  EXPECT_EQ(
      errorOf([] { static_cast<void>(readVdb(path("fog"), "", "", UnknownClass::kLevelSet)); })
          .problem()
          .code,
      "vdb.class");
}

TEST_F(VdbOfOthers, GridsBecomeImagesWhereTheyAre) {
  for (const char* name : {"ball", "turned", "stretched", "mirrored"}) {
    const Image image = readVdbImage(path(name), "", "");
    int looked = 0;
    for (int k = 0; k < image.size[2]; k += 3) {
      for (int j = 0; j < image.size[1]; j += 3) {
        for (int i = 0; i < image.size[0]; i += 3) {
          const double truth = glm::distance(image.toWorld(Vec3(i, j, k)), kCenter) - kRadius;
          if (std::abs(truth) > 1.4e-3) continue;
          ASSERT_NEAR(image.at(i, j, k), 1e3 * truth, 1e-4) << name;  // [mm]
          ++looked;
        }
      }
    }
    EXPECT_GT(looked, 200) << name;
    EXPECT_EQ(image.source, path(name));
  }
  const Image mask = readVdbImage(path("mask"), "", "");
  const Vec3 inside = mask.toIndex(kCenter);
  EXPECT_EQ(
      mask.at(static_cast<int>(std::lround(inside.x)), static_cast<int>(std::lround(inside.y)),
              static_cast<int>(std::lround(inside.z))),
      1.0F);
  EXPECT_EQ(mask.at(0, 0, 0), 0.0F);
  EXPECT_EQ(errorOf([] { static_cast<void>(readVdbImage(path("vectors"), "", "mm")); }).kind(),
            ErrorKind::kInput);
}

TEST_F(VdbOfOthers, CheckFindsNothingWrongWithABall) {
  const GridCheck check = checked("ball");
  EXPECT_FALSE(check.refused);
  ASSERT_TRUE(check.has_distances);
  EXPECT_EQ(check.not_finite.voxels + check.sign_breaks.voxels + check.band_holes.voxels, 0U);
  EXPECT_GT(check.gradient.voxels, 1000U);
  // Central differences on a ball of 12 voxels: errors of voxel^2 / 6 times the third derivatives.
  EXPECT_NEAR(check.gradient.mean, 1.0, 2e-3);
  EXPECT_LT(check.gradient.deviation, 5e-3);
  EXPECT_LT(std::abs(check.gradient.worst - 1.0), 0.02);
  // A voxel's share is a mean over half a voxel to each side, which adds (voxel / radius)^2 / 4.
  EXPECT_NEAR(check.volume, kVolume * (1.0 + 0.25 / 144.0), 1.5e-3 * kVolume);
  EXPECT_NEAR(check.grid.info.voxel_size, 0.5e-3, 1e-12);
}

TEST_F(VdbOfOthers, CheckLooksAtWhatIsRefusedToo) {
  for (const char* name : {"turned", "stretched", "mirrored", "no_class"}) {
    const GridCheck check = checked(name);
    ASSERT_TRUE(check.has_distances) << name;
    EXPECT_EQ(check.sign_breaks.voxels + check.band_holes.voxels, 0U) << name;
    EXPECT_NEAR(check.gradient.mean, 1.0, 5e-3) << name;
    EXPECT_NEAR(check.volume, kVolume, 5e-3 * kVolume) << name;
  }
  const GridCheck unit = checked("no_unit", "cm");
  EXPECT_FALSE(unit.refused);
  EXPECT_NEAR(unit.volume, 1e3 * kVolume, 5.0 * kVolume);
  EXPECT_FALSE(checked("fog").has_distances);
}

TEST_F(VdbOfOthers, CheckFindsAMissingInsideAHoleAndOtherUnits) {
  const GridCheck hollow = checked("hollow");
  EXPECT_FALSE(hollow.refused);
  EXPECT_GT(hollow.sign_breaks.voxels, 100U);
  // The break is at the inner border of the band, 3 voxels below the surface.
  EXPECT_NEAR(glm::distance(hollow.sign_breaks.place, kCenter), kRadius - 1.5e-3, 0.5e-3);
  EXPECT_EQ(hollow.band_holes.voxels, 0U);
  EXPECT_LT(hollow.volume, 0.7 * kVolume);

  const GridCheck torn = checked("torn");
  EXPECT_GT(torn.band_holes.voxels + torn.sign_breaks.voxels, 10U);
  EXPECT_LT(glm::distance(torn.band_holes.place, kCenter + Vec3(kRadius, 0.0, 0.0)), 3e-3);

  const GridCheck voxels = checked("in_voxels");
  EXPECT_NEAR(voxels.gradient.mean, 2.0, 0.01);
}

std::string written(const TempFolder& folder, const openvdb::GridBase::Ptr& grid) {
  const std::string path = folder.path("foreign.vdb");
  openvdb::io::File(path).write({grid});
  return path;
}

openvdb::FloatGrid::Ptr sphereGrid() {
  initializeOpenVdb();
  auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
      6.0F, openvdb::Vec3f(1.0F, 2.0F, 3.0F), 0.5F, 3.0F);
  grid->setName("ball");
  grid->insertMeta("length_unit", openvdb::StringMetadata("mm"));
  return grid;
}

TEST(VdbOfOpenVdb, PointsVectorsDoublesAndFrustums) {
  const TempFolder folder;
  const auto problem = [&](const openvdb::GridBase::Ptr& grid) {
    return errorOf([&] { static_cast<void>(readVdb(written(folder, grid), "", "mm")); }).problem();
  };
  initializeOpenVdb();
  const std::vector<openvdb::Vec3R> places{{0, 0, 0}, {1, 1, 1}};
  const openvdb::points::PointAttributeVector<openvdb::Vec3R> positions(places);
  const auto index =
      openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(positions, 0.5);
  const auto points = openvdb::points::createPointDataGrid<openvdb::points::NullCodec,
                                                           openvdb::points::PointDataGrid>(
      *index, positions, index->transform());
  Problem refused = problem(points);
  EXPECT_EQ(refused.code, "vdb.type");
  EXPECT_NE(refused.message.find("PointDataGrid"), std::string::npos) << refused.message;
  EXPECT_NE(refused.hint.find("particlesToSdf"), std::string::npos);

  auto staggered = openvdb::Vec3SGrid::create();
  staggered->setGridClass(openvdb::GRID_STAGGERED);
  refused = problem(staggered);
  EXPECT_EQ(refused.code, "vdb.type");
  EXPECT_NE(refused.hint.find("vector"), std::string::npos);

  auto doubles = openvdb::DoubleGrid::create(1.5);
  doubles->setGridClass(openvdb::GRID_LEVEL_SET);
  refused = problem(doubles);
  EXPECT_EQ(refused.code, "vdb.type");
  EXPECT_NE(refused.hint.find("palpate convert"), std::string::npos);

  auto frustum = sphereGrid();
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0.0), openvdb::Vec3d(10.0)), 0.5, 2.0, 0.5));
  EXPECT_EQ(problem(frustum).code, "vdb.transform");
  EXPECT_EQ(errorOf([&] { static_cast<void>(readVdbImage(written(folder, frustum), "", "mm")); })
                .problem()
                .code,
            "vdb.transform");
  const auto checks = checkVdb(written(folder, frustum));
  EXPECT_FALSE(checks.at(0).has_distances);
}

TEST(VdbOfOpenVdb, AnActiveInsideIsNoBand) {
  const TempFolder folder;
  auto dense = sphereGrid();
  // Active leaves and tiles inside, with minus the background, as in copies of arrays.
  for (int x = -6; x <= 10; ++x) {
    for (int y = -4; y <= 12; ++y) {
      for (int z = -2; z <= 14; ++z) {
        const openvdb::Coord at(x, y, z);
        if (dense->tree().getValue(at) <= -1.5F) dense->tree().setValueOn(at, -1.5F);
      }
    }
  }
  ASSERT_GT(dense->activeVoxelCount(), sphereGrid()->activeVoxelCount());
  const LevelSet set = readVdb(written(folder, dense), "", "");
  EXPECT_EQ(set.info().active_voxels, sphereGrid()->activeVoxelCount());
  EXPECT_FALSE(gridField(set)->sample(kCenter).in_band);
  expectBall(set, 0.5e-6);
}

TEST(VdbOfOpenVdb, SharedFolderHolds) {
  const std::string path = palpate::testing::scanPath("vdb/sphere.vdb");
  PALPATE_NEEDS_SCAN(path);
  const auto checks = checkVdb(path, "", "mm");
  ASSERT_EQ(checks.size(), 1U);
  const GridCheck& check = checks[0];
  EXPECT_FALSE(check.refused);
  EXPECT_EQ(check.sign_breaks.voxels + check.band_holes.voxels + check.not_finite.voxels, 0U);
  EXPECT_NEAR(check.gradient.mean, 1.0, 1e-3);
  // 125 voxels across, including those of the band whose distance is less than 3: a radius of 59 to
  // 60.
  const double radius = std::cbrt(check.volume * 3.0 / 4.0 / std::numbers::pi) / 0.05e-3;
  EXPECT_GT(radius, 59.0);
  EXPECT_LT(radius, 60.01);
}

TEST(VdbForOthers, VdbRenderSeesTheSurface) {
  const TempFolder folder;
  BakeOptions options;
  options.voxel_size = 0.5e-3;
  options.name = "skin/surface";
  const std::vector<LevelSet> sets{bake(*sphere(kCenter, kRadius), options)};
  writeVdb(folder.path("a.vdb"), sets, false);
  const std::string command =
      "vdb_render '" + folder.path("a.vdb") + "' '" + folder.path("a.ppm") +
      "' -name skin/surface -res 64x64 -shader normal -translate 1,2,40 > '" + folder.path("log") +
      "' 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  std::ifstream picture(folder.path("a.ppm"), std::ios::binary);
  std::string head;
  int width = 0;
  int height = 0;
  int most = 0;
  picture >> head >> width >> height >> most;
  ASSERT_EQ(head, "P6");
  ASSERT_EQ(width * height, 64 * 64);
  picture.get();
  const std::string pixels((std::istreambuf_iterator<char>(picture)), {});
  ASSERT_EQ(pixels.size(), std::size_t{3} * 64 * 64);
  // Pixels that differ from the corner's background show the ball: 37 mm away, with a view angle of
  // 45 degrees, it takes some 40 % of the height.
  int other = 0;
  for (std::size_t p = 0; p < pixels.size(); p += 3) {
    other += pixels.compare(p, 3, pixels, 0, 3) != 0 ? 1 : 0;
  }
  EXPECT_GT(other, 300);
  EXPECT_LT(other, 2500);
}

}  // namespace
}  // namespace palpate::vdb
