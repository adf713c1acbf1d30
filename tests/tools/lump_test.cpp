// data/scenes/lump.yaml: a lump felt through the skin, compared with an independent computation of
// layered elasticity.

#include <cstdio>

#include "folders/folders.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene_file.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

/// [N/m] Stiffness of these layers under a rigid punch of 5 mm (lump_oracle.py).
double punch(const std::string& layers) {
  // Soft tissue is incompressible; slightly below 0.5, the oracle's equations agree with that limit
  // to 1e-3.
  const std::string command = "/usr/bin/python3 '" + test::sourceFolder() +
                              "/tests/tools/lump_oracle.py' 0.005 0.4999 " + layers;
  FILE* pipe = popen(command.c_str(), "r");
  double stiffness = 0.0;
  EXPECT_EQ(pipe == nullptr ? 0 : std::fscanf(pipe, "%lf", &stiffness), 1) << command;
  EXPECT_EQ(pclose(pipe), 0) << command;
  return stiffness;
}

/// [N] Force when pressed `depth` [m] at (x, 0).
double felt(const ScenePtr& scene, double x, double depth) {
  const auto renderer = makeRenderer(scene);
  (void)renderer->update({.position = {x, 0.0, 0.005}});
  return renderer->update({.position = {x, 0.0, -depth}}).force.z;
}

TEST(Lump, TheForceRisesOverItAsLayeredElasticityHasIt) {
  const ScenePtr scene = compile(readScene(test::sourceFolder() + "/data/scenes/lump.yaml"));
  const double beside = punch("400,0.04 8000");
  const double over = punch("400,0.008 4000,0.01 400,0.022 8000");
  EXPECT_GT(over / beside, 1.3) << "there is something to be felt";
  for (const double depth : {0.2e-3, 1e-3, 2e-3}) {
    EXPECT_NEAR(felt(scene, 0.06, depth), beside * depth, 0.01 * beside * depth);
    EXPECT_NEAR(felt(scene, 0.0, depth), over * depth, 0.01 * over * depth);
    // The rise itself, within 3 %; of this, 2 % come from taking the punch's pressure as that on a
    // half-space.
    const double rise = felt(scene, 0.0, depth) - felt(scene, 0.06, depth);
    EXPECT_NEAR(rise, (over - beside) * depth, 0.03 * (over - beside) * depth);
  }
}

TEST(Lump, OtherStacksAgreeToo) {
  struct Row {
    const char* oracle;
    const char* layers;
    double within;  ///< relative tolerance; the thinner the top layer, the less the pressure
                    ///< resembles that on a half-space
  };
  for (const Row& row : {
           Row{"400,0.005 4000", "{point: [0, 0, -5], normal: [0, 0, 1]}", 0.03},
           Row{"400,0.01 4000", "{point: [0, 0, -10], normal: [0, 0, 1]}", 0.01},
           Row{"400,0.03 4000", "{point: [0, 0, -30], normal: [0, 0, 1]}", 0.01},
       }) {
    const ScenePtr scene = compile(parseScene(
        std::string("{palpate: 1, length: mm, materials: {skin: {stiffness: 400 N/m, composite: "
                    "{radius: 5, depth: 200}}, knot: {stiffness: 4000 N/m}}, layers: [{name: a, "
                    "inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: skin}, "
                    "{name: b, inside: {half_space: ") +
            row.layers + "}, wall: knot}]}",
        "test"));
    const double expected = 1e-3 * punch(row.oracle);
    EXPECT_NEAR(felt(scene, 0.0, 1e-3), expected, row.within * expected) << row.oracle;
  }
}

}  // namespace
}  // namespace palpate::testing
