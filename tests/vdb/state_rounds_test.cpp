// States of the example scenes with images, saved and restored at random ticks, exact to the last
// bit; scenes of fields alone are tested with the library.

#include "support/state_rounds.h"

#include <gtest/gtest.h>

#include "folders/folders.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/register.h"

namespace palpate::test {
namespace {

class StateRoundsOfImages : public ::testing::TestWithParam<const char*> {};

TEST_P(StateRoundsOfImages, GoOnToTheLastBit) {
  SceneRegistry registry;
  vdb::registerKinds(registry, {});
  const ScenePtr scene = compile(
      readScene(palpate::test::sourceFolder() + "/data/scenes/" + std::string(GetParam()) + ".yaml",
                registry));
  for (const RendererKind kind : {RendererKind::kConstraint, RendererKind::kPaper}) {
    SCOPED_TRACE(kind == RendererKind::kPaper ? "paper" : "constraint");
    EXPECT_TRUE(goesOnFromItsStates(scene, kind, runsSlowTests() ? 200 : 12));
    EXPECT_TRUE(areApart(scene, kind));
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, StateRoundsOfImages,
                         ::testing::Values("contrast", "five_layers", "head", "needle"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace palpate::test
