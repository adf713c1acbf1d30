// The state of every example scene that needs neither scans nor grids, saved and restored at random
// ticks: all results agree to the last bit.

#include "support/state_rounds.h"

#include <gtest/gtest.h>

#include <iostream>
#include <type_traits>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

struct Case {
  const char* scene;
  RendererKind kind;
};

class StateRounds : public ::testing::TestWithParam<Case> {};

TEST_P(StateRounds, GoOnToTheLastBit) {
  EXPECT_TRUE(goesOnFromItsStates(sceneNamed(GetParam().scene), GetParam().kind,
                                  runsSlowTests() ? 200 : 25));
}

TEST_P(StateRounds, OfTwoRenderersFedInTurnsAreApart) {
  EXPECT_TRUE(areApart(sceneNamed(GetParam().scene), GetParam().kind));
}

std::vector<Case> casesOfAll() {
  std::vector<Case> out;
  // Scenes with images are tested with vdb.
  for (const char* scene : {"composite_tube", "container", "crease", "csg", "csg_part", "cup",
                            "fields", "flag", "flank", "heart", "lattice", "lump", "metaballs",
                            "reference", "slab", "sponge", "valve_tube"}) {
    out.push_back({scene, RendererKind::kConstraint});
    out.push_back({scene, RendererKind::kPaper});
  }
  return out;
}

INSTANTIATE_TEST_SUITE_P(Examples, StateRounds, ::testing::ValuesIn(casesOfAll()),
                         [](const ::testing::TestParamInfo<Case>& made) {
                           return std::string(made.param.scene) +
                                  (made.param.kind == RendererKind::kPaper ? "_paper"
                                                                           : "_constraint");
                         });

TEST(StateRoundsOfAll, TheStateIsOneValueOfThisSize) {
  std::cout << "sizeof(RendererState): " << sizeof(RendererState) << " bytes\n";
  RecordProperty("bytes", static_cast<int>(sizeof(RendererState)));
  EXPECT_TRUE(std::is_trivially_copyable_v<RendererState>);
  // The size that its documentation states.
  EXPECT_NEAR(static_cast<double>(sizeof(RendererState)), 24e3, 1.5e3);
}

}  // namespace
}  // namespace palpate::test
