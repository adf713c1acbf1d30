// Thin plates as grids: a plate that a grid holds is never passed through, at any speed.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/vdb/bake.h"
#include "support/error_of.h"
#include "support/field_contract.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kVoxel = 0.25e-3;

ScenePtr sceneOf(FieldPtr field) {
  SceneDescription description;
  LayerDescription layer;
  layer.name = "plate";
  layer.inside = std::make_shared<FieldSource>(std::move(field));
  description.layers.push_back(layer);
  return compile(description);
}

const Pose kTurned{rotationAbout(Vec3(1, 2, 3), 0.8), Vec3(1e-3, -2e-3, 0.5e-3)};

FieldPtr plate(double thickness, double width, const Pose& pose) {
  return place(box(Vec3(0.0), Vec3(width, width, thickness)), pose);
}

TEST(HardPlate, OfFourVoxelsIsNeverTunnelled) {
  const double half = 0.5e-3;
  for (const Pose& pose : {Pose{}, kTurned}) {
    const ScenePtr scene =
        sceneOf(gridField(bake(*plate(2.0 * half, 0.05, pose), voxels(kVoxel, 6.0))));
    for (const double speed : {1.0, 5.0, 20.0}) {
      for (const double slant : {0.0, 30.0, 50.0}) {
        int tunnelled = 0;
        const double step = speed * 1e-3;
        const Vec3 way =
            glm::normalize(Vec3(std::sin(slant * kDegree), 0.3 * std::sin(slant * kDegree),
                                -std::cos(slant * kDegree)));
        for (int phase = 0; phase < 200; ++phase) {
          const auto renderer = makeRenderer(scene);
          const double ahead = 0.02 + step * phase / 200.0;
          bool through = false;
          Vec3 hip(0.0);
          TickResult out;
          for (double s = -ahead; s < 8e-3; s += step) {
            hip = s * way;
            out = renderer->update({pose.apply(hip)});
            through = through || pose.applyInverse(out.proxy).z < 0.0;
          }
          for (int i = 0; i < 3; ++i) out = renderer->update({pose.apply(hip)});
          const Vec3 proxy = pose.applyInverse(out.proxy);
          if (hip.z < half - kVoxel) {
            // The proxy must be held on the near face, within a tenth of a voxel, and be pushed
            // back out.
            through = through || !out.contact || std::fabs(proxy.z - half) > 0.1 * kVoxel;
          }
          tunnelled += through ? 1 : 0;
        }
        EXPECT_EQ(tunnelled, 0) << speed << " m/s, " << slant << " degrees";
      }
    }
  }
}

TEST(HardPlate, WhatAGridCannotHoldIsRefusedOrWhole) {
  // Whatever the thickness and pose: either the bake is refused, or no straight line leads through
  // the plate.
  palpate::test::Random random(3);
  int refused = 0;
  int whole = 0;
  for (const double thickness : {0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 1.2, 2.0}) {
    for (int trial = 0; trial < 4; ++trial) {
      const Pose pose{
          rotationAbout(random.direction(), random.uniform(0.0, trial == 0 ? 0.0 : 3.0)),
          kVoxel * random.in({Vec3(-1.0), Vec3(1.0)})};
      FieldPtr grid;
      try {
        grid = gridField(bake(*plate(thickness * kVoxel, 0.01, pose), voxels(kVoxel, 6.0)));
      } catch (const Error&) {
        ++refused;
        continue;
      }
      int holes = 0;
      for (int ray = 0; ray < 400; ++ray) {
        const Vec3 foot = random.in({Vec3(-0.004, -0.004, 0.0), Vec3(0.004, 0.004, 0.0)});
        double lowest = kInfinity;
        for (double z = -2.0; z <= 2.0; z += 0.02) {
          lowest = std::min(lowest, grid->value(pose.apply(foot + Vec3(0, 0, z * kVoxel))));
        }
        holes += lowest >= 0.0 ? 1 : 0;
      }
      EXPECT_EQ(holes, 0) << thickness << " voxels thick, trial " << trial;
      whole += holes == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(whole, 0);
}

TEST(HardPlate, SharpEdgesAndTipsAreNoPlates) {
  // Spikes end in less than a voxel, and a grid rounds them off; this opens no hole.
  const FieldPtr spike = cone(Vec3(0.0), Vec3(0, 0, 1), 3e-3, 10e-3);
  EXPECT_NO_THROW((void)bake(*spike, voxels(kVoxel, 6.0)));
  const FieldPtr wedge = intersect({box(Vec3(0.0), Vec3(0.01)), halfSpace(Vec3(0.0), Vec3(1, 0, 2)),
                                    halfSpace(Vec3(0.0), Vec3(1, 0, -2))});
  EXPECT_NO_THROW((void)bake(*place(wedge, kTurned), voxels(kVoxel, 6.0)));
  // The wall of a hollow ball, half a voxel thick, counts as a plate.
  const FieldPtr ball = subtract({sphere(Vec3(0.0), 5e-3), sphere(Vec3(0.0), 5e-3 - 0.5 * kVoxel)});
  const Error error = errorOf([&] { (void)bake(*ball, voxels(kVoxel, 6.0)); });
  EXPECT_EQ(error.problem().code, "bake.too_thin");
  EXPECT_NE(error.problem().message.find("0.12"), std::string::npos) << error.problem().message;
}

}  // namespace
}  // namespace palpate::vdb
