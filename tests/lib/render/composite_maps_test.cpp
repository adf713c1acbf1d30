// A wall felt together with the layers beneath, whose stiffness varies from place to place.

#include <gtest/gtest.h>

#include "lib/render/energy_loop.h"
#include "palpate/contact/layered.h"
#include "palpate/fields/primitives.h"
#include "support/test_maps.h"

namespace palpate::test {
namespace {

constexpr double kRadius = 5e-3;
constexpr double kSkin = 8e-3;         // [m] thick
const Vec3 kSkinRise(2e4, 5e3, 0.0);   // [N/m^2]
const Vec3 kBoneRise(-3e4, 6e4, 0.0);  // [N/m^2]

double skinAt(const Vec3& p) { return 800.0 + glm::dot(kSkinRise, p); }
double boneAt(const Vec3& p) { return 5000.0 + glm::dot(kBoneRise, p); }

ScenePtr skinOnBone() {
  SceneDescription description;
  Material skin;
  skin.name = "skin";
  skin.stiffness = testing::linearMap(skinAt(Vec3(0.0)), kSkinRise, {1.0, 1e5});
  skin.composite.radius = kRadius;
  skin.composite.depth = 0.1;
  Material bone;
  bone.name = "bone";
  bone.stiffness = testing::linearMap(boneAt(Vec3(0.0)), kBoneRise, {1.0, 1e5});
  description.materials = {skin, bone};
  for (const auto& [name, material, top] :
       {std::tuple{"tissue", "skin", 0.0}, std::tuple{"ground", "bone", -kSkin}}) {
    LayerDescription layer;
    layer.name = name;
    layer.inside = std::make_shared<FieldSource>(halfSpace(Vec3(0, 0, top), Vec3(0, 0, 1)));
    layer.wall.material = material;
    description.layers.push_back(layer);
  }
  return compile(description);
}

/// The energy [J] stored in the stack's spring with the hand at `hip`, straight below its place on
/// the skin.
double energyAt(const Vec3& hip) {
  const std::array<StackLayer, 2> stack = {StackLayer{skinAt(hip), kSkin}, {boneAt(hip), 0.0}};
  return 0.5 * stackStiffness(stack, kRadius).stiffness * hip.z * hip.z;
}

TEST(CompositeMaps, TheForceIsWhatTheEnergyOfTheStackFallsBy) {
  constexpr double kStep = 1e-5;
  const ScenePtr scene = skinOnBone();
  for (const Vec3& hip :
       {Vec3(0.0, 0.0, -1e-3), Vec3(5e-3, -3e-3, -2e-3), Vec3(-8e-3, 9e-3, -1e-3)}) {
    Drive hand(scene);
    (void)hand.to(Vec3(hip.x, hip.y, 1e-3));
    const Vec3 force = hand.walk(hip).force;
    const Vec3 expected = fallOf(energyAt, hip, kStep);
    for (int axis = 0; axis < 3; ++axis) {
      // The third derivative of the energy is far below 1e-2 N/m^2, and the position of the wall is
      // exact to 1e-9 of a feature.
      EXPECT_NEAR(force[axis], expected[axis], 1e-6) << axis;
    }
    EXPECT_GT(std::fabs(force.x), 1e-3) << "the maps are felt sideways";
  }
}

}  // namespace
}  // namespace palpate::test
