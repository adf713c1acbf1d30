// Grids of booleans, masks and densities as openings of ports: they tell inside from outside, and
// are not read as distances.

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>

#include "palpate/render/haptic_renderer.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/register.h"
#include "support/temp_file.h"

namespace palpate::vdb {
namespace {

constexpr double kVoxel = 0.5;   // [mm]
constexpr double kRadius = 6.0;  // [mm] of the opening, a ball at (5, 0, 20) mm

class SceneMask : public ::testing::Test {
 protected:
  SceneMask() {
    initializeOpenVdb();
    registerKinds(registry_);
  }

  /// Fills `grid` with f(distance from the middle in mm), and writes it.
  template <typename Grid, typename F>
  void write(const std::string& file, openvdb::GridClass grid_class, const F& f) {
    auto grid = Grid::create();
    grid->setName("opening");
    grid->setGridClass(grid_class);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(kVoxel));
    auto accessor = grid->getAccessor();
    const int n = static_cast<int>(std::ceil((kRadius + 2.0) / kVoxel));
    const openvdb::Coord middle(10, 0, 40);
    for (int i = -n; i <= n; ++i) {
      for (int j = -n; j <= n; ++j) {
        for (int k = -n; k <= n; ++k) {
          const auto value = f(kVoxel * std::sqrt(static_cast<double>(i * i + j * j + k * k)));
          if (value == decltype(value)(0)) continue;
          if constexpr (std::is_same_v<Grid, openvdb::MaskGrid>) {
            accessor.setValueOn(middle.offsetBy(i, j, k));
          } else {
            accessor.setValue(middle.offsetBy(i, j, k), value);
          }
        }
      }
    }
    openvdb::io::File(folder_.path(file)).write(openvdb::GridPtrVec{grid});
  }

  ScenePtr sceneWith(const std::string& mask) {
    return compile(readScene(folder_.file("scene.yaml", R"(
palpate: 1
length: mm
materials: {glass: {stiffness: 1000 N/m}}
layers: [{name: ball, inside: {sphere: {center: [0, 0, 0], radius: 20.6}}, wall: glass}]
ports: [{name: hole, between: [outside, ball], where: {mask: )" +
                                                            mask + "}}]\n"),
                             registry_));
  }

  /// Whether a hand that moves straight down at x [mm] gets into the ball.
  static bool opensAt(const ScenePtr& scene, double x) {
    const auto renderer = makeRenderer(scene);
    TickResult out;
    for (double z = 30.0; z > 10.0; z -= 0.5) {
      out = renderer->update({{1e-3 * x, 0.0, 1e-3 * z}, Vec3(0.0)});
    }
    return out.region == 1;
  }

  void expectOpening(const std::string& mask) {
    const ScenePtr scene = sceneWith(mask);
    // The ball of the mask cuts the ball's surface (y = 0) between about x = -1.2 and 10.7 mm.
    const auto surface = [](double x) { return std::sqrt(20.6 * 20.6 - x * x); };
    for (double x = -8.0; x <= 18.0; x += 0.25) {
      const double off = std::hypot(x - 5.0, surface(x) - 20.0) - kRadius;
      if (std::fabs(off) < 0.4 * kVoxel) continue;  // the border is only as sharp as the voxels
      EXPECT_EQ(opensAt(scene, x), off < 0.0) << mask << " at " << x;
    }
  }

  void expectError(const std::string& mask, const std::string& says) {
    try {
      (void)sceneWith(mask);
      ADD_FAILURE() << mask;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_EQ(error.problem().file, folder_.path("scene.yaml"));
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  }

  palpate::testing::TempFolder folder_;
  SceneRegistry registry_;
};

TEST_F(SceneMask, ABooleanGridIsWhereItIsTrue) {
  write<openvdb::BoolGrid>("b.vdb", openvdb::GRID_UNKNOWN, [](double r) { return r < kRadius; });
  expectOpening("{file: b.vdb, units: mm}");
  write<openvdb::MaskGrid>("m.vdb", openvdb::GRID_UNKNOWN, [](double r) { return r < kRadius; });
  expectOpening("{file: m.vdb, name: opening, units: mm}");
  write<openvdb::Int32Grid>("i.vdb", openvdb::GRID_UNKNOWN,
                            [](double r) { return r < kRadius ? 7 : 0; });
  expectOpening("{file: i.vdb, units: mm}");
}

TEST_F(SceneMask, AFogVolumeIsWhereItIsDense) {
  // Dense inside, thin outside: read as a level set, the ball would be the outside.
  write<openvdb::FloatGrid>("f.vdb", openvdb::GRID_FOG_VOLUME, [](double r) {
    return static_cast<float>(std::clamp(0.5 + (kRadius - r) / 2.0, 0.0, 1.0));
  });
  expectOpening("{file: f.vdb, units: mm}");
  write<openvdb::FloatGrid>("g.vdb", openvdb::GRID_FOG_VOLUME, [](double r) {
    return static_cast<float>(std::clamp(30.0 + 10.0 * (kRadius - r), 0.0, 60.0));
  });
  expectOpening("{file: g.vdb, units: mm, above: 30}");
}

TEST_F(SceneMask, ErrorsNameTheSceneAndWhatToWrite) {
  write<openvdb::BoolGrid>("b.vdb", openvdb::GRID_UNKNOWN, [](double r) { return r < kRadius; });
  expectError("{file: b.vdb, units: mm, above: 0.5}", "no densities");
  expectError("{file: b.vdb, name: closing, units: mm}", "it holds opening");
  expectError("{file: b.vdb}", "unit");
  const auto ball = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
      6.0F, openvdb::Vec3f(0.0F), static_cast<float>(kVoxel));
  ball->setName("ball");
  openvdb::io::File(folder_.path("l.vdb")).write(openvdb::GridPtrVec{ball});
  expectError("{file: l.vdb, units: mm}", "write grid:");
  write<openvdb::FloatGrid>("thin.vdb", openvdb::GRID_FOG_VOLUME,
                            [](double r) { return r < kRadius ? 0.2F : 0.0F; });
  expectError("{file: thin.vdb, units: mm}", "0.5");
}

}  // namespace
}  // namespace palpate::vdb
